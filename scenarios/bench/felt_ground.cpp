#include "scenarios/bench/felt_ground.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kLifted = 0.5;  // m
constexpr autopilot::Time kFeltRest = std::chrono::milliseconds(500);

}  // namespace

std::optional<std::string_view> FeltGround::observe(const autopilot::Signals& signals) {
  const autopilot::FlightMemory& memory = signals.flight.memory;
  const bool flies = signals.flight.phase != autopilot::FlightPhase::kDisarmed;
  const double height = memory.launch_N.z() - signals.estimate.p_NB_N.z();
  if (!airborne_) {
    if (!flies || !memory.launched || memory.on_ground || height < kLifted) return std::nullopt;
    airborne_ = true;
    felt_since_.reset();
    return "lifted_off";
  }
  // Who feels the ground and is disarmed has landed, however soon the pilot did it.
  const bool rests =
      !flies && (felt_since_ || signals.flight.cause == autopilot::PhaseCause::kRestsWithPilot);
  if (!memory.on_ground) felt_since_.reset();
  if (memory.on_ground && !felt_since_) felt_since_ = signals.estimate.stamp;
  const bool felt = felt_since_ && signals.estimate.stamp - *felt_since_ >= kFeltRest;
  if (!felt && !rests) return std::nullopt;
  airborne_ = false;
  return "landed";
}

}  // namespace ironbird::scenarios
