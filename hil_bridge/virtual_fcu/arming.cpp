#include "hil_bridge/virtual_fcu/arming.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

struct Row {
  State state;
  Event event;
  Transition transition;
};

constexpr Row kRows[] = {
    {State::kInit, Event::kInitialized, {State::kPreflight, kNothing}},

    {State::kPreflight, Event::kRcFound, {State::kPreflight, kClearRcLost | kFailsafeOff}},
    {State::kPreflight, Event::kRcLost, {State::kPreflight, kSetRcLost}},
    {State::kPreflight, Event::kError, {State::kError, kErrorOn}},
    {State::kPreflight, Event::kRequestArm, {State::kPreflight, kAskConditions}},

    {State::kError, Event::kRcLost, {State::kError, kSetRcLost}},
    {State::kError, Event::kRcFound, {State::kError, kClearRcLost | kFailsafeOff}},
    {State::kError, Event::kNoError, {State::kPreflight, kErrorOff}},
    {State::kError, Event::kRequestArm, {State::kError, kRefuse}},

    {State::kCalibrating, Event::kCalibrationComplete, {State::kArmed, kArm}},
    {State::kCalibrating, Event::kCalibrationFailed, {State::kPreflight, kNothing}},
    {State::kCalibrating, Event::kRcLost, {State::kCalibrating, kSetRcLost}},
    {State::kCalibrating, Event::kError, {State::kError, kErrorOn}},

    {State::kArmed, Event::kRcLost, {State::kFailsafe, kFailsafeOn | kSetRcLost}},
    {State::kArmed, Event::kRequestDisarm, {State::kPreflight, kDisarm | kErrorStateIfError}},
    {State::kArmed, Event::kError, {State::kArmed, kErrorOn}},
    {State::kArmed, Event::kNoError, {State::kArmed, kErrorOff}},

    {State::kFailsafe, Event::kRcFound, {State::kArmed, kFailsafeOff | kClearRcLost}},
    {State::kFailsafe, Event::kError, {State::kFailsafe, kErrorOn}},
    {State::kFailsafe, Event::kRequestDisarm, {State::kError, kDisarm}},
};

constexpr std::size_t kStates = 6;
constexpr std::size_t kEvents = 9;
using Table = std::array<std::array<Transition, kEvents>, kStates>;

constexpr Table make_table() {
  Table table{};
  for (std::size_t s = 0; s < kStates; ++s) {
    for (Transition& cell : table[s]) cell = {static_cast<State>(s), kNothing};
  }
  for (const Row& row : kRows) {
    table[static_cast<std::size_t>(row.state)][static_cast<std::size_t>(row.event)] = row.transition;
  }
  return table;
}

constexpr Table kTable = make_table();

}  // namespace

Transition transition(State state, Event event) {
  return kTable[static_cast<std::size_t>(state)][static_cast<std::size_t>(event)];
}

void Arming::apply(const Transition& step) {
  state_ = step.next;
  const std::uint16_t actions = step.actions;
  if (actions == kNothing) return;
  if ((actions & kFailsafeOn) != 0) failsafe_ = true;
  if ((actions & kFailsafeOff) != 0) failsafe_ = false;
  if ((actions & kErrorOn) != 0) error_ = true;
  if ((actions & kErrorOff) != 0) error_ = false;
  if ((actions & kArm) != 0) armed_ = true;
  if ((actions & kDisarm) != 0) armed_ = false;
  if ((actions & kErrorStateIfError) != 0 && error_) state_ = State::kError;
  if ((actions & kSetRcLost) != 0) set_error(kErrorRcLost);
  if ((actions & kClearRcLost) != 0) clear_error(kErrorRcLost);
}

ArmingReply Arming::request_arm(const ArmingConditions& conditions) {
  const Transition step = transition(state_, Event::kRequestArm);
  if ((step.actions & kRefuse) != 0) return ArmingReply::kRefused;
  if ((step.actions & kAskConditions) == 0) return ArmingReply::kIgnored;
  if (!conditions.throttle_low) return ArmingReply::kThrottleHigh;
  if (!conditions.throttle_protected) return ArmingReply::kUnprotected;
  if (conditions.calibrate_gyro) {
    state_ = State::kCalibrating;
    return ArmingReply::kCalibrating;
  }
  state_ = State::kArmed;
  armed_ = true;
  return ArmingReply::kArmed;
}

void Arming::set_error(ErrorBit bit) {
  errors_ |= bit;
  process_errors();
}

void Arming::clear_error(ErrorBit bit) {
  if ((errors_ & bit) == 0) return;
  errors_ = static_cast<std::uint16_t>(errors_ & ~bit);
  process_errors();
}

bool Arming::take_change() {
  const bool changed = state_ != reported_state_ || errors_ != reported_errors_;
  reported_state_ = state_;
  reported_errors_ = errors_;
  return changed;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
