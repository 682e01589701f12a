#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "hil_bridge/rosflight/vocabulary.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// Where the firmware is between power-up and flight.
enum class State : std::uint8_t { kInit, kPreflight, kArmed, kError, kFailsafe, kCalibrating };

constexpr std::array<std::pair<State, std::string_view>, 6> enumerators(State) {
  return {{{State::kInit, "init"},
           {State::kPreflight, "preflight"},
           {State::kArmed, "armed"},
           {State::kError, "error"},
           {State::kFailsafe, "failsafe"},
           {State::kCalibrating, "calibrating"}}};
}

/// What can happen to it.
enum class Event : std::uint8_t {
  kInitialized,
  kError,    ///< some error bit is set; repeated in every pass
  kNoError,  ///< no error bit is set; repeated in every pass
  kRcLost,
  kRcFound,
  kRequestArm,
  kRequestDisarm,
  kCalibrationComplete,
  kCalibrationFailed
};

constexpr std::array<std::pair<Event, std::string_view>, 9> enumerators(Event) {
  return {{{Event::kInitialized, "initialized"},
           {Event::kError, "error"},
           {Event::kNoError, "no_error"},
           {Event::kRcLost, "rc_lost"},
           {Event::kRcFound, "rc_found"},
           {Event::kRequestArm, "request_arm"},
           {Event::kRequestDisarm, "request_disarm"},
           {Event::kCalibrationComplete, "calibration_complete"},
           {Event::kCalibrationFailed, "calibration_failed"}}};
}

using enum rosflight::ErrorBit;
using rosflight::ErrorBit;

/// What a transition does besides changing the state, as bits.
enum ArmingAction : std::uint16_t {
  kNothing = 0x000,
  kSetRcLost = 0x001,    ///< raises the error bit
  kClearRcLost = 0x002,  ///< clears the error bit
  kFailsafeOn = 0x004,
  kFailsafeOff = 0x008,
  kErrorOn = 0x010,
  kErrorOff = 0x020,
  kArm = 0x040,
  kDisarm = 0x080,
  kAskConditions = 0x100,     ///< arming depends on the sticks and on parameters
  kRefuse = 0x200,            ///< arming is refused because of the error bits
  kErrorStateIfError = 0x400  ///< the next state is kError when the error flag is set
};

/// One cell of the state machine.
struct Transition {
  State next = State::kInit;
  std::uint16_t actions = kNothing;
};

/// The state machine as a table; cells not listed by the firmware keep the state and do nothing.
Transition transition(State state, Event event);

/// What arming depends on besides the state.
struct ArmingConditions {
  bool throttle_low = false;        ///< stick below RC_ARM_THRESHOLD
  bool throttle_protected = false;  ///< TAKE_MIN_THR, or the throttle override switch is on
  bool calibrate_gyro = false;      ///< ARM_CAL_GYRO

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("throttle_low", self.throttle_low, "1", "throttle stick below the threshold");
    visit("throttle_protected", self.throttle_protected, "1", "the pilot's throttle limits the companion's");
    visit("calibrate_gyro", self.calibrate_gyro, "1", "calibrate the gyro first");
  }
};

/// What became of a request to arm.
enum class ArmingReply : std::uint8_t {
  kIgnored,
  kArmed,
  kCalibrating,
  kThrottleHigh,
  kUnprotected,
  kRefused
};

/// State machine of the firmware: decides whether motors may turn and which errors forbid it.
/// There is no way to arm from the companion, no landing and no kill in it.
class Arming {
 public:
  State state() const { return state_; }
  bool armed() const { return armed_; }
  bool failsafe() const { return failsafe_; }
  bool error() const { return error_; }
  std::uint16_t errors() const { return errors_; }

  /// Any event but a request to arm.
  void handle(Event event) { apply(transition(state_, event)); }

  /// The pilot asks to arm.
  ArmingReply request_arm(const ArmingConditions& conditions);

  void set_error(ErrorBit bit);
  void clear_error(ErrorBit bit);

  /// Issues kError or kNoError, whichever holds. Once per pass.
  void process_errors() { handle(errors_ != 0 ? Event::kError : Event::kNoError); }

  /// Did the state or the error code change since this was last asked?
  bool take_change();

 private:
  void apply(const Transition& transition);

  State state_ = State::kInit;
  bool armed_ = false;
  bool failsafe_ = false;
  bool error_ = false;
  std::uint16_t errors_ = 0;
  State reported_state_ = State::kInit;
  std::uint16_t reported_errors_ = 0;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
