#include "autopilot/controller/upright_watch.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kOverturned = 0.5;     // cosine of 60 deg
constexpr double kAskedUpright = 0.7;   // cosine of 45 deg
constexpr double kLiesStill = 1.0;      // s
constexpr double kOutOfControl = 3.0;   // s, several times what righting itself takes a vehicle that can
constexpr double kRightedItself = 0.5;  // s, longer than a tumbling vehicle is upright
constexpr double kMeansIt = 0.5;        // s, longer than the loops ask a tumbling vehicle to lean far

}  // namespace

void UprightWatch::look(const StateEstimate& estimate, bool usable, bool still,
                        const std::optional<double>& asked, bool taken) {
  if (!usable) {
    lies_.forget();
    upright_.forget();
    blind_ = true;
    return;
  }
  const Time now = estimate.stamp;
  if (blind_) out_of_control_.pass_over(now - seen_);
  blind_ = false;
  seen_ = now;
  const double upright = estimate.upright();
  leans_ = upright < kOverturned;
  lies_.note(leans_ && still, now);
  upright_.note(upright > kAskedUpright, now);
  const bool righted = upright_.lasts(kRightedItself, now);
  const bool expected_upright = asked && *asked > kAskedUpright;
  asked_far_.note(!expected_upright, now);
  if (taken || asked_far_.lasts(kMeansIt, now) || righted) {
    out_of_control_.forget();
  } else {
    out_of_control_.note((leans_ && expected_upright) || out_of_control_.so(), now);
  }
  if (out_of_control_.lasts(kOutOfControl, now)) given_up_ = true;
  if (taken && righted) given_up_ = false;
}

void UprightWatch::forgive() {
  given_up_ = false;
  out_of_control_.forget();
}

bool UprightWatch::lies(Time now) const {
  return lies_.lasts(kLiesStill, now);
}

bool UprightWatch::stops(Time now) const {
  return given_up_ || lies(now);
}

}  // namespace ironbird::autopilot
