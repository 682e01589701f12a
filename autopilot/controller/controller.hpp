#pragma once

#include <optional>
#include <string_view>

#include "autopilot/controller/flight_phase.hpp"
#include "autopilot/module/module.hpp"
#include "autopilot/request.hpp"
#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/fcu_command.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Turns a setpoint at any of the twelve entry points into a command for the FCU, and owns the flight phase.
class Controller : public Module {
 public:
  /// One step. When the estimated position has jumped, the point to hold jumps along. Non-finite commands are
  /// replaced by SilenceCommand; a non-finite setpoint is taken as none. An estimate that is lost and whose
  /// stamp stands still is worked on whatever the period, for its next stamp may never come.
  /// @param setpoint  what to fly in the offboard phase
  /// @param landing   the trajectory has come to a landing waypoint: begin the descent
  /// @return the command; valid until the next call
  const FcuCommand& run(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                        const FcuStatus& status);

  /// The phase after the last step, and why it is that one.
  FlightPhase phase() const { return step_.phase; }
  PhaseCause cause() const { return step_.cause; }

  /// What a successor must know. Launch and beginning of the phase are kept for every controller.
  const FlightMemory& memory() const { return memory_; }

  /// The operator's wish. Granted at the next work, which may be a successor's, or refused with a reason;
  /// never kept for later. Of several before that the last one counts.
  RequestOutcome request(FlightWish wish, const StateEstimate& estimate, const FcuStatus& status);

  void reset() override;
  void hand_over(Handover& handover) const override;

  /// Starts in the phase that the predecessor was in, with its memory and the wish granted to it.
  void take_over(const Handover& left) override;

 protected:
  /// The work. Sets `step` to the phase that it was in.
  /// @param dt  time since the previous call, s; 0 on the first
  virtual FcuCommand control(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                             const FcuStatus& status, double dt, PhaseStep& step) = 0;

  /// Why a wish cannot be granted now; empty when it can.
  virtual std::string_view refusal(FlightWish wish, const StateEstimate& estimate,
                                   const FcuStatus& status) const = 0;

  /// It is the last that was granted since the last work.
  bool wished(FlightWish wish) const { return wish_ == wish; }

  /// The estimate is lost and its stamp has not moved for so many steps that no duration means anything.
  bool time_lost() const { return standing_still_ > kMostStandingStill; }

  /// The memory, to write in.
  FlightMemory& notebook() { return memory_; }

 private:
  static constexpr int kMostStandingStill = 100;  // 0.25 s of a common IMU: a moved clock is followed sooner

  bool stands_still(const StateEstimate& estimate);

  FcuCommand last_ = SilenceCommand{};
  PhaseStep step_;
  FlightMemory memory_;
  std::optional<FlightWish> wish_;                  // for the next work only
  Vector3 position_reset_sum_N_ = Vector3::Zero();  // seen
  Time stamp_{-1};                                  // of the step before
  int standing_still_ = 0;                          // steps
  Divider divider_;
};

}  // namespace ironbird::autopilot
