#pragma once

#include <cstdint>
#include <optional>

#include "autopilot/types/fcu_command.hpp"
#include "autopilot/types/state_estimate.hpp"
#include "hil_bridge/executive/unit_watch.hpp"
#include "hil_bridge/interlock/interlock.hpp"

namespace ironbird::hil_bridge {

/// What the operator wants, now.
struct OperatorWishes {
  bool release = false;
  bool reset = false;
  bool kill = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("release", self.release, "1", "the run may begin");
    visit("reset", self.reset, "1", "after a kill: everything is all right again");
    visit("kill", self.kill, "1", "stop");
  }
};

/// Keeps the interlock: tells it in every control period how unit, autopilot, bench and operator are, and
/// lets it look at every command. docs/safety.md, rules R1 to R6 and R12.
///
/// It is the gate of the line too: a motor command that did not just come through `answer` does not leave.
class Guard final : public Gate {
 public:
  /// @param watch  outlives this
  Guard(const InterlockConfig& config, UnitWatch& watch) : interlock_(config), watch_(watch) {}

  void take(const Arrival& arrival) { watch_.take(arrival); }

  /// Looks at everything. Once in every control period at least, before commands are sent.
  /// @param bench_in_time  the control loop keeps its period
  const InterlockStatus& step(const autopilot::StateEstimate& estimate, bool bench_in_time, Time now);

  /// @param answers  stamp of the sensors that the autopilot's command answers
  /// @return what is to be sent, or none
  std::optional<rosflight::OffboardControl> answer(const autopilot::FcuCommand& command, Time answers,
                                                   Time now);

  /// What is to be sent in a period in which the autopilot was not asked: after a kill on the bench, zeros.
  std::optional<rosflight::OffboardControl> unasked(Time now);

  /// Closes the gate for good: nothing reopens it but a reset on the ground.
  void close(Time now);

  std::optional<rosflight::Message> pass(const rosflight::Message& message, Time now) override;

  void want(const OperatorWishes& wishes) { wishes_ = wishes; }
  /// How the process that guards the bench is. Where there is none it is always awake.
  void watchdog(bool awake) { watchdog_awake_ = awake; }

  const InterlockStatus& status() const { return interlock_.status(); }
  /// What the last step looked at.
  const InterlockInputs& inputs() const { return inputs_; }

 private:
  std::optional<rosflight::OffboardControl> approve(const StampedCommand& wanted, Time now);

  Interlock interlock_;
  UnitWatch& watch_;
  OperatorWishes wishes_;
  bool watchdog_awake_ = true;
  InterlockInputs inputs_;
  std::uint64_t number_ = 0;
  std::optional<rosflight::OffboardControl> approved_;  // and not yet sent
};

}  // namespace ironbird::hil_bridge
