#pragma once

#include <array>
#include <optional>

#include "autopilot/controller/cascade_params.hpp"
#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/fcu_command.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Slower than this, m/s, a vehicle is as good as at rest: it stops at once with 1.1 m/s^2, and its landing
/// gear slides without tipping.
inline constexpr double kSlow = 0.5;

/// A place to come to and rest at, or to rest above while sinking.
struct Approach {
  Vector3 p_N = Vector3::Zero();
  std::optional<double> v_down;
  double heading = 0.0;
  double deceleration = 2.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "the place, from the local origin");
    visit("v_down", self.v_down, "m/s", "vertical velocity instead of the height of the place");
    visit("heading", self.heading, "rad", "the heading to keep");
    visit("deceleration", self.deceleration, "m/s^2", "the most to slow down with, horizontally");
  }
};

/// The loops of the controller: a setpoint at any of the twelve entry points becomes a command for the FCU.
/// ROScopter paper, controller table.
///
/// Entries 0, 1, 3, 4 end in 2 (acceleration); 2 ends in 6 (FCU angle mode) or 10 (torque), 5 in 6, 9 to 11
/// in 8 (torque and thrust); 6 and 7 are the FCU's own. It has no flight phase.
class Cascade {
 public:
  explicit Cascade(const CascadeParams& params) { set_params(params); }

  void set_params(const CascadeParams& params);

  /// What one step works with.
  struct Step {
    double dt = 0.0;                ///< s, since the previous step
    bool integrate = true;          ///< false: all integrals are 0
    bool thrust_in_newtons = true;  ///< entries 0 to 4 become torque and thrust, not angles and throttle
  };

  /// One step. Nothing is sent for NoSetpoint. Loops that were not used since the previous step forget their
  /// past.
  FcuCommand fly(const ControlSetpoint& setpoint, const StateEstimate& estimate, const Step& step);

  /// One step towards a place, as entry 0 or 4, but never faster than one may be that far from where one
  /// wants to rest.
  FcuCommand come_to(const Approach& approach, const StateEstimate& estimate, const Step& step);

  /// Where `come_to` would bring the vehicle to rest without asking for another velocity than it has now. Its
  /// height is the present one. Slower than kSlow it is where the vehicle is.
  Vector3 resting_place(const StateEstimate& estimate, double deceleration) const;

  /// One step of a descent on height and attitude alone: level, no turn, no horizontal loop.
  /// @param v_down  m/s
  FcuCommand sink_level(double v_down, const StateEstimate& estimate, const Step& step);

  /// Lets the next step go on from `command`, the last one of another controller: the integrals are set so
  /// that, from the present attitude, it asks for the same as far as it can be told from the command.
  void resume(const FcuCommand& command, const StateEstimate& estimate);

  /// Forgets the past of all loops.
  void reset();

  /// Share of the weight that the last command lifts, 1.
  double lift() const { return lift_; }

  /// Cosine of the lean that was asked for when it flew last; none when that was rates or torques.
  const std::optional<double>& asked_upright() const { return asked_upright_; }

 private:
  enum Loop : std::uint8_t {
    kPosN,
    kPosE,
    kPosD,
    kVelN,
    kVelE,
    kVelD,
    kYawToRate,
    kRoll,
    kPitch,
    kYaw,
    kRollRate,
    kPitchRate,
    kYawRate,
    kLoops
  };

  FcuCommand enter(const PositionHeading& s);
  FcuCommand enter(const VelocityHeightHeadingRate& s);
  FcuCommand enter(const AccelerationHeadingRate& s);
  FcuCommand enter(const VelocityHeadingRate& s);
  FcuCommand enter(const PositionClimbHeading& s);
  FcuCommand enter(const AngleHeadingThrottle& s);
  FcuCommand enter(const AngleHeadingRateThrottle& s);
  FcuCommand enter(const RateThrottle& s);
  FcuCommand enter(const TorqueThrust& s);
  FcuCommand enter(const AngleHeadingThrust& s);
  FcuCommand enter(const AngleHeadingRateThrust& s);
  FcuCommand enter(const RateThrust& s);
  FcuCommand enter(const Approach& s);
  FcuCommand enter(const NoSetpoint&) { return SilenceCommand{}; }

  FcuCommand track(const VelocityHeadingRate& s, double max_horizontal_speed);
  template <class Enter>
  FcuCommand run_loops(const StateEstimate& estimate, const Step& step, Enter&& enter_at);
  double run(Loop loop, double error, double rate);
  double run_filtered(Loop loop, double error, double measurement);
  double yaw_rate_for(double heading);
  double stiffness() const;
  void note_lean(double roll, double pitch);
  bool near_ground() const;
  void aim(Loop loop, double error, double rate);
  void aim_at(const Vector3& torque_B);

  CascadeParams params_;
  std::array<Pid, kLoops> loops_;
  std::array<bool, kLoops> used_{};
  const StateEstimate* estimate_ = nullptr;
  Step step_;
  double lift_ = 0.0;
  std::optional<double> asked_upright_;
  std::array<std::optional<double>, kLoops> aims_{};  // what the loops are to give in the next step
};

}  // namespace ironbird::autopilot
