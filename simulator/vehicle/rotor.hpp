#pragma once

#include <array>
#include <numbers>

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Where a rotor sits and which way it turns.
struct RotorMount {
  Vector3 position = Vector3::Zero();
  int direction = 1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("position", self.position, "m", "hub from the centre of mass, in B", -10.0, 10.0);
    visit("direction", self.direction, "1", "+1 turns about +Bz, clockwise seen from above; -1 the other way",
          -1.0, 1.0);
  }
};

/// One kind of propeller on one kind of motor. Source: Small Unmanned Aircraft, section 4.3.
///
/// Coefficients are polynomials in the advance ratio J = 2 pi V/(omega D): CT = CT[0] + CT[1] J + CT[2] J^2.
struct RotorParams {
  double diameter = 0.381;
  std::array<double, 3> CT = {0.08729101, -0.11006411, -0.12928596};
  std::array<double, 3> CQ = {0.00428594, 0.00146105, -0.01440988};
  double K_V = 0.028937;
  double resistance = 0.042;
  double no_load_current = 1.5;
  double inertia = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("diameter", self.diameter, "m", "of the propeller", 0.01, 5.0);
    visit("CT", self.CT, "1", "thrust coefficients: constant, linear, quadratic in the advance ratio", -10.0,
          10.0);
    visit("CQ", self.CQ, "1", "torque coefficients: constant, linear, quadratic in the advance ratio", -10.0,
          10.0);
    visit("K_V", self.K_V, "V*s/rad", "back electromotive force per speed, and torque per current", 1e-5,
          10.0);
    visit("resistance", self.resistance, "ohm", "of motor, speed controller and leads", 1e-4, 10.0);
    visit("no_load_current", self.no_load_current, "A", "drawn without a propeller; stands for friction", 0.0,
          50.0);
    visit("inertia", self.inertia, "kg*m^2",
          "of propeller and bell about the shaft; 0: the speed follows its command at once", 0.0, 1.0);
  }
};

/// Thrust, torque and electrical side of one rotor, as pure functions of its speed.
///
/// The inflow is that along the shaft while the vehicle moves into its own thrust; descending or sideways
/// inflow is taken as still air. Coefficients do not fall below 1e-4. No force in the rotor's plane, no
/// flapping.
class Rotor {
 public:
  static constexpr double kLeastCoefficient = 1e-4;
  static constexpr double kLeastSpeed = 1e-4;  ///< rad/s
  static constexpr double kStictionSpeed =
      10.0;  ///< rad/s: below it friction fades out, so that a rotor can rest

  Rotor() = default;
  explicit Rotor(const RotorParams& params);

  /// Inflow as the speed 2 pi V_z/D, rad/s; `V_z` is the axial airspeed, m/s, negative ones count as zero.
  double inflow(double V_z) const { return V_z > 0.0 ? V_z * inflow_factor_ : 0.0; }

  /// Thrust, N, at `speed` rad/s >= 0, `inflow` as above, density kg/m^3.
  double thrust(double speed, double inflow, double air_density) const {
    return thrust_factor_ * air_density * coefficient(params_.CT, speed, inflow);
  }

  /// Aerodynamic torque, N*m, against the direction of turning.
  double torque(double speed, double inflow, double air_density) const {
    return torque_factor_ * air_density * coefficient(params_.CQ, speed, inflow);
  }

  /// Current through the motor at `voltage` across it, A; negative when the motor brakes.
  double current(double voltage, double speed) const {
    return (voltage - params_.K_V * speed) * conductance_;
  }

  /// Friction as a current, A; fades to nothing with the speed.
  double friction_current(double speed) const {
    return speed >= kStictionSpeed ? params_.no_load_current
                                   : params_.no_load_current * speed / kStictionSpeed;
  }

  /// Speed at which motor and propeller balance, rad/s, >= kLeastSpeed. @param voltage across the motor, V
  double balance_speed(double voltage, double inflow, double air_density) const;

  const RotorParams& params() const { return params_; }
  double conductance() const { return conductance_; }

 private:
  /// Coefficient times squared speed; without the division by the speed that the advance ratio asks for.
  static double coefficient(const std::array<double, 3>& c, double speed, double inflow) {
    const double floor = kLeastCoefficient * speed * speed;
    const double value = (c[0] * speed + c[1] * inflow) * speed + c[2] * inflow * inflow;
    return value > floor ? value : floor;
  }

  RotorParams params_;
  double inflow_factor_ = 0.0;  // 2 pi/D
  double thrust_factor_ = 0.0;  // D^4/(4 pi^2)
  double torque_factor_ = 0.0;  // D^5/(4 pi^2)
  double conductance_ = 0.0;    // 1/R
};

}  // namespace ironbird::simulator
