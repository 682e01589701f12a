#pragma once

#include <array>

#include "simulator/environment/environment.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/types/rotor_commands.hpp"
#include "simulator/vehicle/battery.hpp"
#include "simulator/vehicle/rotor.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

/// One multirotor: from commands, state and air to the wrench about its centre of mass.
///
/// Rotor speeds obey J_r dw/dt = K_V ((V - K_V w)/R - i_0) - Q(w), integrated by the plant; with a rotor
/// inertia of zero the speed is the root of the right-hand side. The speed controller puts command times
/// battery voltage across the motor and brakes as hard as it drives; at a command of exactly zero it lets go,
/// and friction and air stop the rotor. The battery's terminal voltage is solved for together with the motor
/// currents. Reaction of rotor acceleration and the rotors' gyroscopic moment act on the body. Source: Small
/// Unmanned Aircraft, sections 4.3 and 14.2. It does not know what it touches: contact is the plant's.
class Vehicle : public ForceModel {
 public:
  /// Only keeps a reference to `environment`, which may be constructed later but must outlive the vehicle.
  /// @throws std::invalid_argument naming parameter, value and bound
  Vehicle(const VehicleParams& params, const Environment& environment);

  /// Commands held until the next call; clamped to 0..1, and what is not a number counts as 0.
  void set_commands(const RotorCommands& commands);

  /// Wrench and rotor accelerations of one stage. The first stage of a step has offset 0.
  Forces evaluate(const RigidBodyState& state, const RotorSpeeds& rotors, double offset) override;

  /// With a rotor inertia of zero replaces the speeds by those that balance; otherwise leaves them.
  void settle(const RigidBodyState& state, RotorSpeeds& rotors) override;

  /// Draws from the battery what the motors took. Called once after every plant step.
  /// @param dt      the step, s
  /// @param state   after it
  /// @param rotors  after it, rad/s
  void finish_step(double dt, const RigidBodyState& state, const RotorSpeeds& rotors);

  /// With the payload. After `set_payload` the plant is to be configured again.
  const MassProperties& mass_properties() const { return mass_properties_; }

  double battery_voltage() const { return voltage_; }                    ///< V, at the terminals
  double battery_current() const { return current_; }                    ///< A, >= 0
  double battery_charge_used() const { return battery_.charge_used(); }  ///< A*s

  /// Rotor `rotor` gives `efficiency`, 0..1, of its thrust and torque. At 0 its motor has no power either.
  void set_rotor_efficiency(int rotor, double efficiency);
  /// From now on the battery has `fraction`, 0..1, of its capacity left.
  void set_battery_charge(double fraction);
  /// Carries `payload`, kg, at the centre of mass, instead of what it carried.
  void set_payload(double payload);

  int rotor_count() const { return rotor_count_; }

  /// Speeds, rad/s, at which the sum of thrusts carries the weight in still air at the local origin, the same
  /// for every rotor.
  RotorSpeeds equilibrium_speeds() const;
  /// Command, 0..1, that holds `equilibrium_speeds` with the battery as it is.
  double equilibrium_command() const;

  const VehicleParams& params() const { return params_; }

 private:
  struct Air {
    Vector3 V_a_B;  // velocity of the vehicle against the air
    double density = 0.0;
    double inflow = 0.0;
  };

  Air air_at(const RigidBodyState& state, const Matrix3& R_NB) const;
  double rotor_wrench(const RotorSpeeds& rotors, const Air& air, const Vector3& w_NB_B, Forces& forces);
  void instantaneous_wrench(const Air& air, Forces& forces, double& total_thrust) const;
  double terminal_voltage(const RotorSpeeds& rotors) const;
  double ground_force(double height, double total_thrust) const;

  VehicleParams params_;
  const Environment* environment_;
  Rotor rotor_;
  Battery battery_;
  MassProperties mass_properties_;
  int rotor_count_ = 0;
  std::array<double, kMaxRotors> x_{}, y_{}, direction_{};
  std::array<double, kMaxRotors> command_{};
  std::array<double, kMaxRotors> efficiency_{};
  double payload_ = 0.0;
  double voltage_ = 0.0;
  double current_ = 0.0;
  double density_ = 1.225;
  double density_gradient_ = 0.0;
  double density_height_ = 0.0;
};

}  // namespace ironbird::simulator
