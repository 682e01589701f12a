#include "scenarios/bench/ground_watch.hpp"

#include <utility>

namespace ironbird::scenarios {

namespace {

constexpr simulator::Time kContactRest{500'000'000};
// A hop of the landing gear is no flight.
constexpr simulator::Time kFlight{300'000'000};
// A landing gear that chatters on the ground has not left it.
constexpr simulator::Time kChatter{50'000'000};
// A vehicle that lies for so long has not only rocked.
constexpr simulator::Time kLies{1'000'000'000};
constexpr simulator::Time kNever{-1};
// What a landing gear has to take without damage: certification drops that of a small rotorcraft from 13
// inches (14 CFR 27.725), with which it comes down at 2.55 m/s. It is six times the speed that the controller
// lands with, and more than a vehicle has that sinks on an empty battery at nearly its weight: that is a hard
// landing, no crash.
constexpr double kHardestLanding = 2.5;  // m/s
// A gear with feet 0.14 m aside of a centre of mass 0.20 m up, as the X650's, holds a vehicle up to 35 deg;
// so one that rests at 45 deg stands on other parts, be it on a slope of 10 deg.
constexpr double kLeastUpright = 0.707;  // cosine of 45 deg

/// Cosine of the angle between Bz and Nz.
double uprightness(const simulator::Truth& truth) {
  return 1.0 - 2.0 * (truth.q_NB.x() * truth.q_NB.x() + truth.q_NB.y() * truth.q_NB.y());
}

}  // namespace

std::optional<std::string_view> GroundWatch::observe(const simulator::Truth& truth) {
  const auto said = truth.in_contact ? on_ground(truth) : off_ground(truth);
  if (said) return said;
  return fallen_over(truth) ? std::optional<std::string_view>("crashed") : std::nullopt;
}

std::optional<std::string_view> GroundWatch::on_ground(const simulator::Truth& truth) {
  free_since_ = kNever;
  if (contact_since_ == kNever) contact_since_ = truth.stamp;
  const double struck_with = std::exchange(sink_, 0.0);
  if (!airborne_) return std::nullopt;
  const bool strikes = struck_with > kHardestLanding;
  if (!strikes && truth.stamp - contact_since_ < kContactRest) return std::nullopt;
  airborne_ = false;
  crashed_ = strikes || uprightness(truth) < kLeastUpright;
  return crashed_ ? "crashed" : "landed";
}

std::optional<std::string_view> GroundWatch::off_ground(const simulator::Truth& truth) {
  sink_ = truth.v_NB_N.z();
  if (free_since_ == kNever) free_since_ = truth.stamp;
  if (truth.stamp - free_since_ >= kChatter) contact_since_ = kNever;
  if (airborne_ || truth.stamp - free_since_ < kFlight) return std::nullopt;
  airborne_ = true;
  crashed_ = false;
  return "lifted_off";
}

bool GroundWatch::fallen_over(const simulator::Truth& truth) {
  if (airborne_ || uprightness(truth) >= kLeastUpright) {
    leaning_since_ = kNever;
    return false;
  }
  if (leaning_since_ == kNever) leaning_since_ = truth.stamp;
  if (crashed_ || truth.stamp - leaning_since_ < kLies) return false;
  crashed_ = true;
  return true;
}

}  // namespace ironbird::scenarios
