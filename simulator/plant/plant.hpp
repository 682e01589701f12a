#pragma once

#include <Eigen/Core>

#include "simulator/types/linear_algebra.hpp"
#include "simulator/types/rigid_body_state.hpp"
#include "simulator/types/rotor_commands.hpp"
#include "simulator/types/wrench.hpp"

namespace ironbird::simulator {

/// Mass properties about the centre of mass, in body axes.
struct MassProperties {
  double mass = 1.0;
  Matrix3 J_Bcm_B = Matrix3::Identity();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("mass", self.mass, "kg", "mass");
    visit("J_Bcm_B", self.J_Bcm_B, "kg*m^2", "inertia about the centre of mass");
  }
};

/// The vehicle's own states that change within a step, one speed per rotor, rad/s; unused ones stay zero.
using RotorSpeeds = Eigen::Array<double, kMaxRotors, 1>;

/// What the vehicle answers in a stage of the integrator.
struct Forces {
  Wrench wrench;
  RotorSpeeds rotor_acceleration = RotorSpeeds::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("wrench", self.wrench, "", "gravity not included");
    visit("rotor_acceleration", self.rotor_acceleration, "rad/s^2",
          "of each rotor; 0 for those that are not there");
  }
};

/// The forces on the vehicle as a function of where it is. Asked once in every stage of the integrator: with
/// a wrench held over the step a fourth-order integrator is only first order.
class ForceModel {
 public:
  virtual ~ForceModel() = default;

  /// @param state    rigid-body state of the stage
  /// @param rotors   rotor speeds of the stage, rad/s
  /// @param offset   time of the stage after the start of the step, s
  virtual Forces evaluate(const RigidBodyState& state, const RotorSpeeds& rotors, double offset) = 0;

  /// Called at the end of every step: puts in the rotor speeds that are no states because they follow from
  /// the rest at once.
  virtual void settle(const RigidBodyState&, RotorSpeeds&) {}
};

/// Integrates one free rigid body, and the rotor speeds with it, against the ground and obstacles. NED, FRD,
/// SI.
///
/// A plant knows neither rotors nor air: it asks the force model, in each stage of its scheme, what acts and
/// how the rotor speeds change, and integrates both with the same weights.
class Plant {
 public:
  virtual ~Plant() = default;

  /// @param mass     of the vehicle; positive, with a positive-definite inertia that obeys the triangle
  /// inequality
  /// @param gravity  m/s^2, along +Nz
  /// Keeps the state: a payload may be dropped in flight.
  virtual void configure(const MassProperties& mass, double gravity) = 0;

  /// Sets the state and forgets everything about the past.
  virtual void reset(const RigidBodyState& state, const RotorSpeeds& rotors) = 0;

  /// Advances by `dt`, s, > 0.
  virtual void step(double dt, ForceModel& forces) = 0;

  virtual const RigidBodyState& state() const = 0;
  virtual const RotorSpeeds& rotors() const = 0;

  /// Touched something in the last step.
  virtual bool in_contact() const = 0;

  /// Why the engine can no longer be believed (it reset itself, or its state is not finite), or null.
  virtual const char* failure() const { return nullptr; }

  /// The longest step, s, that is well behaved where the vehicle is now: short within reach of something. The
  /// world divides its step by it.
  virtual double contact_step() const { return 0.5e-3; }
};

}  // namespace ironbird::simulator
