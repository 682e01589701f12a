#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "hil_bridge/can/can_frame.hpp"

namespace ironbird::hil_bridge::transport {

using can::CanFrame;
using can::ReceivedFrame;
using can::Time;

/// How much a controller still trusts itself on its bus. The error counters decide: 96, 128, 256.
enum class BusState : std::uint8_t { kActive, kWarning, kPassive, kOff, kDown };

constexpr std::array<std::pair<BusState, std::string_view>, 5> enumerators(BusState) {
  return {{{BusState::kActive, "active"},
           {BusState::kWarning, "warning"},
           {BusState::kPassive, "passive"},
           {BusState::kOff, "off"},
           {BusState::kDown, "down"}}};
}

/// What happens on a bus besides frames.
enum class BusEventKind : std::uint8_t {
  kActive,         ///< few errors again
  kWarning,        ///< 96 errors
  kPassive,        ///< 128 errors: the controller no longer disturbs others
  kOff,            ///< 256 errors: it takes no part until it is restarted
  kRestarted,      ///< takes part again
  kDown,           ///< the interface was switched off
  kUp,             ///< switched on again
  kGone,           ///< the interface was unplugged
  kBusError,       ///< a frame was broken
  kNoAcknowledge,  ///< nobody confirmed a frame: alone on the bus, or a wrong bit rate
  kLost,           ///< frames arrived faster than they were fetched
  kSendTimeout,    ///< the controller could not get rid of a frame
};

inline constexpr std::size_t kBusEventKinds = 12;

/// For people.
constexpr std::string_view name_of(BusEventKind kind) {
  constexpr std::string_view kNames[] = {
      "error-active", "error warning", "error-passive", "bus-off",        "restarted",   "down",
      "up",           "gone",          "bus error",     "no acknowledge", "frames lost", "send time-out"};
  return kNames[static_cast<std::size_t>(kind)];
}

struct BusEvent {
  BusEventKind kind = BusEventKind::kActive;
  Time stamp{};
  std::uint32_t count = 0;
  std::uint16_t send_errors = 0;
  std::uint16_t receive_errors = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("kind", self.kind, "1", "what happened");
    visit("stamp", self.stamp, "ns", "when");
    visit("count", self.count, "1", "frames lost");
    visit("send_errors", self.send_errors, "1", "the controller's error counter, 0 when it does not tell");
    visit("receive_errors", self.receive_errors, "1",
          "the controller's error counter, 0 when it does not tell");
  }
};

/// Lets those frames through whose identifier agrees where the mask has ones, and whose length of identifier
/// is the same.
struct FrameFilter {
  std::uint32_t identifier = 0;
  std::uint32_t mask = 0;
  bool extended = true;

  constexpr bool passes(const CanFrame& frame) const {
    return frame.extended == extended && ((frame.identifier ^ identifier) & mask) == 0;
  }

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("identifier", self.identifier, "1", "to agree with");
    visit("mask", self.mask, "1", "which bits count");
    visit("extended", self.extended, "1", "29 bits instead of 11");
  }
};

/// What went through one end of a bus.
struct BusCounters {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t refused = 0;
  std::uint64_t lost = 0;
  std::uint64_t events_lost = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("sent", self.sent, "1", "frames taken for sending");
    visit("received", self.received, "1", "frames fetched");
    visit("refused", self.refused, "1",
          "frames not taken: queue full, bus down, or none that the bus can carry");
    visit("lost", self.lost, "1", "frames that arrived faster than they were fetched");
    visit("events_lost", self.events_lost, "1", "events that nobody fetched");
  }
};

/// One end of a CAN bus, in this process or on a wire. Never waits, and after it is built never throws. Does
/// not hear itself. A frame that was taken for sending may still fail: the controller repeats it, and reports
/// an event when it is in trouble.
class FrameBus {
 public:
  virtual ~FrameBus() = default;

  /// @return false when the frame was not taken
  virtual bool send(const CanFrame& frame) = 0;

  /// The oldest frame that arrived and was not fetched, or nothing. Error frames are turned into events.
  virtual std::optional<ReceivedFrame> receive() = 0;

  /// The oldest event. Events come in with `receive`.
  virtual std::optional<BusEvent> take_event() = 0;

  /// What passes one of the filters is received; without filters everything.
  /// @param filters  at most 32
  virtual void set_filters(std::span<const FrameFilter> filters) = 0;

  virtual BusState state() const = 0;

  /// Can it carry CAN FD frames?
  virtual bool fd() const = 0;

  virtual const BusCounters& counters() const = 0;
};

inline constexpr std::size_t kMostFilters = 32;

}  // namespace ironbird::hil_bridge::transport
