#pragma once

#include <optional>

#include "autopilot/controller/since.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// What counts as lying still.
struct RestLimits {
  double rest_speed = 0.15;
  double rest_rate = 0.05;
  double rest_time = 2.0;
  double idle_output = 0.35;

  bool operator==(const RestLimits&) const = default;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("rest_speed", self.rest_speed, "m/s", "slower than this the vehicle may lie on the ground", 0.01,
          1.0);
    visit("rest_rate", self.rest_rate, "rad/s", "turning slower than this it may", 0.001, 1.0);
    visit("rest_time", self.rest_time, "s",
          "how long both must last under pilot or failsafe, to need a new request to take off", 0.1, 60.0);
    visit("idle_output", self.idle_output, "1",
          "with all motors driven less than this the vehicle falls unless something carries it", 0.01, 0.9);
  }
};

/// Feels the ground while pilot or failsafe have the vehicle: it lies still, or its motors idle and yet it
/// neither falls nor sinks very fast. Less than that its velocity does not tell: the blow of a touch-down is
/// shorter than a sample, and leaves the estimate wrong by metres per second.
///
/// When it is handed back with idling motors it may lie or fly, until it falls for as long as no bounce
/// lasts, or is felt to lie. So it may when it has just struck the ground in other hands, or so soon after
/// them that they brought it there: what the estimate missed of the blow must not be flown against.
class RestWatch {
 public:
  /// One step.
  /// @param usable  the estimate is
  /// @param taken   pilot or failsafe have the vehicle, or the pilot its throttle
  void look(const StateEstimate& estimate, bool usable, const FcuStatus& status, bool taken,
            const RestLimits& limits);

  /// Slow and hardly turning, whoever has it.
  bool still() const { return still_; }

  /// The same, in other hands.
  bool still_with_others() const { return still_with_others_.so(); }

  /// It was handed back with idling motors, or struck something, and it is not known yet whether it flies.
  bool may_lie() const { return may_lie_; }

  /// It lies on the ground and was put there by others.
  /// @param likely  it is near the height of the launch, or overturned: less time convinces
  bool rests(Time now, bool likely, const RestLimits& limits) const;

  void reset();
  /// Goes on where another one stopped.
  void restore(bool may_lie) { may_lie_ = may_lie; }

 private:
  void feel_fall(const StateEstimate& estimate, bool idle);
  void feel_blow(const StateEstimate& estimate);

  std::optional<Time> last_;  // none: no velocity to compare with
  double v_down_ = 0.0;       // m/s, of the step before
  double a_down_ = 0.0;       // m/s^2, low-passed
  bool still_ = false;
  bool may_lie_ = false;
  Since still_with_others_;
  Since carried_;  // although its motors idle, in other hands
  Since falling_;  // with idling motors
  Since struck_;   // in other hands or soon after
  std::optional<Time> taken_last_;
  double struck_down_ = 0.0;  // m, down, where it was struck
};

}  // namespace ironbird::autopilot
