#include "scenarios/bench/ground_watch.hpp"

namespace ironbird::scenarios {

namespace {

constexpr simulator::Time kRest{500'000'000};
// A hop of the landing gear is no flight.
constexpr simulator::Time kFlight{300'000'000};
// A landing gear that chatters on the ground has not left it.
constexpr simulator::Time kChatter{50'000'000};
constexpr simulator::Time kNever{-1};

}  // namespace

std::optional<std::string_view> GroundWatch::observe(const simulator::Truth& truth) {
  if (truth.in_contact) {
    free_since_ = kNever;
    if (contact_since_ == kNever) contact_since_ = truth.stamp;
    if (airborne_ && truth.stamp - contact_since_ >= kRest) {
      airborne_ = false;
      return "landed";
    }
  } else {
    if (free_since_ == kNever) free_since_ = truth.stamp;
    if (truth.stamp - free_since_ >= kChatter) contact_since_ = kNever;
    if (!airborne_ && truth.stamp - free_since_ >= kFlight) {
      airborne_ = true;
      return "lifted_off";
    }
  }
  return std::nullopt;
}

}  // namespace ironbird::scenarios
