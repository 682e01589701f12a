#include "autopilot/controller/rest_watch.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::autopilot {

namespace {

// Enough where it likely lies; longer than a bounce is slow at its top while less than 0.93 of the weight is
// lifted.
constexpr double kShortestRest = 0.45;  // s
// Motors that idle carry less than half of the weight, so a free vehicle falls with half of gravity or more;
// what lies on the ground accelerates only by errors of the accelerometer and of its tilt.
constexpr double kFalls = 3.0;           // m/s^2
constexpr double kCarriedTime = 0.2;     // s: a pilot's throttle comes to the outputs in a tenth of that
constexpr double kLongestBounce = 0.25;  // s, which is 8 cm high: a fall, and no bounce, is longer
constexpr double kOutputHolds = 0.5;     // s, that the FCU's word on its outputs holds
constexpr double kLag = 0.05;            // s, of the acceleration
constexpr double kBlow = 20.0;           // m/s^2 upwards, low-passed so: more than propellers make
constexpr double kBlowHolds = 5.0;       // s, in which an estimate that missed part of it has settled
constexpr double kHandedBack = 2.0;      // s, in which a blow is still the doing of who flew before
constexpr double kClearOfBlow = 1.0;     // m above the place of the blow: it flies
// Faster down than this it flies: the air carries a fall that comes near its greatest speed, and the estimate
// of what has struck the ground may go on sinking, but by what the blow was short of, not by so much.
constexpr double kSinks = 8.0;  // m/s

}  // namespace

void RestWatch::look(const StateEstimate& estimate, bool usable, const FcuStatus& status, bool taken,
                     const RestLimits& limits) {
  const bool fresh = seconds(status.stamp - status.output_stamp) < kOutputHolds;
  const bool idle = fresh && status.greatest_output && *status.greatest_output < limits.idle_output;
  if (!usable) {
    last_.reset();
    still_ = false;
    still_with_others_.forget();
    carried_.forget();
    falling_.forget();
    may_lie_ = taken ? idle || struck_.so() : may_lie_ && idle;
    return;
  }
  feel_fall(estimate, idle);
  if (taken) taken_last_ = estimate.stamp;
  feel_blow(estimate);
  const double speed = estimate.position_known ? estimate.v_NB_B.norm() : std::abs(estimate.v_NB_N().z());
  still_ = speed < limits.rest_speed && estimate.w_NB_B.norm() < limits.rest_rate;
  const bool sinks = v_down_ > kSinks;
  if (falling_.lasts(kLongestBounce, estimate.stamp) || sinks) struck_.forget();
  if (taken || struck_.so()) {
    may_lie_ = idle || struck_.so();
  } else if (falling_.lasts(kLongestBounce, estimate.stamp) || sinks || !idle) {
    may_lie_ = false;
  }
  still_with_others_.note(still_ && (taken || may_lie_ || status.overridden()), estimate.stamp);
  carried_.note(idle && !sinks && std::abs(a_down_) < kFalls && (taken || may_lie_), estimate.stamp);
}

void RestWatch::feel_fall(const StateEstimate& estimate, bool idle) {
  const double v_down = estimate.v_NB_N().z();
  const double dt = last_ ? seconds(estimate.stamp - *last_) : 0.0;
  if (dt > 0.0) a_down_ += ((v_down - v_down_) / dt - a_down_) * dt / (kLag + dt);
  if (!last_) a_down_ = 0.0;
  last_ = estimate.stamp;
  v_down_ = v_down;
  falling_.note(idle && a_down_ >= kFalls, estimate.stamp);
}

void RestWatch::feel_blow(const StateEstimate& estimate) {
  const Time now = estimate.stamp;
  const bool by_others = taken_last_ && seconds(now - *taken_last_) < kHandedBack;
  if (a_down_ < -kBlow && by_others) {
    struck_.forget();
    struck_.note(true, now);
    struck_down_ = estimate.p_NB_N.z();
  }
  const bool clear = estimate.p_NB_N.z() < struck_down_ - kClearOfBlow;
  if (clear || struck_.lasts(kBlowHolds, now)) struck_.forget();
}

bool RestWatch::rests(Time now, bool likely, const RestLimits& limits) const {
  const auto enough = [&](double when_likely) {
    return likely ? std::min(when_likely, limits.rest_time) : limits.rest_time;
  };
  return carried_.lasts(enough(kCarriedTime), now) || still_with_others_.lasts(enough(kShortestRest), now);
}

void RestWatch::reset() {
  *this = RestWatch{};
}

}  // namespace ironbird::autopilot
