#pragma once

#include <array>
#include <limits>

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

  /// Density of the air, kg/m^3, at a height above the local origin, m.
  double air_density(double height) const;

  double battery_voltage() const { return voltage_; }                    ///< V, at the terminals
  double battery_current() const { return current_; }                    ///< A, >= 0
  double battery_charge_used() const { return battery_.charge_used(); }  ///< A*s

  /// Rotor `rotor` gives `efficiency`, 0..1, of its thrust and torque. At 0 its motor has no power either,
  /// and the air stops it.
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
  /// What the air does at one instant.
  struct Flow {
    Vector3 V_a_B;         // of the vehicle against the air, m/s
    double density = 0.0;  // kg/m^3
    double inflow = 0.0;   // of the rotors, rad/s
    double gain = 1.0;     // of the thrust, by the ground
  };

  Flow flow_at(const RigidBodyState& state) const;
  double thrust_gain(double height) const;
  void remember_density(double height);
  void add_rotors(const RotorSpeeds& rotors, const Flow& flow, const Vector3& w_NB_B, Forces& forces) const;
  void add_rotors_without_inertia(const Flow& flow, Forces& forces) const;
  void add_drag(const Flow& flow, Wrench& wrench) const;
  double polynomial_force(double height) const;
  double terminal_voltage(const RotorSpeeds& rotors) const;
  double drawn_current(double voltage, const RotorSpeeds& rotors) const;

  VehicleParams params_;
  const Environment* environment_;
  Rotor rotor_;
  Battery battery_;
  MassProperties mass_properties_;
  int rotor_count_ = 0;
  bool has_inertia_ = false;
  double inverse_rotor_inertia_ = 0.0;
  double hub_z_ = 0.0;  // mean over the rotors, m
  std::array<double, kMaxRotors> x_{};
  std::array<double, kMaxRotors> y_{};
  std::array<double, kMaxRotors> direction_{};
  std::array<double, kMaxRotors> command_{};  // as told
  std::array<double, kMaxRotors> drive_{};    // command_, 0 when the motor has no power
  std::array<double, kMaxRotors> efficiency_{};
  double drag_area_ = 0.0;  // CD A/2
  double voltage_ = 0.0;
  double current_ = 0.0;
  // Taken again when the vehicle has climbed or sunk by more than kDensityReach.
  DensityProfile density_{.height = std::numeric_limits<double>::infinity()};
};

}  // namespace ironbird::simulator
