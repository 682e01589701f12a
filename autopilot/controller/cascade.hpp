#pragma once

#include <array>
#include <optional>

#include "autopilot/controller/cascade_params.hpp"
#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/fcu_command.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

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
  FcuCommand enter(const NoSetpoint&) { return SilenceCommand{}; }

  template <class Enter>
  FcuCommand run_loops(const StateEstimate& estimate, const Step& step, Enter&& enter_at);
  double run(Loop loop, double error, double rate);
  double run_filtered(Loop loop, double error, double measurement);
  double yaw_rate_for(double heading);
  bool near_ground() const;
  void aim(Loop loop, double error, double rate);
  void aim_at(const Vector3& torque_B);

  CascadeParams params_;
  std::array<Pid, kLoops> loops_;
  std::array<bool, kLoops> used_{};
  const StateEstimate* estimate_ = nullptr;
  Step step_;
  double lift_ = 0.0;
  std::array<std::optional<double>, kLoops> aims_{};  // what the loops are to give in the next step
};

}  // namespace ironbird::autopilot
