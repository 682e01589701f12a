#include "hil_bridge/transport/can_error_frame.hpp"

#include <linux/can.h>
#include <linux/can/error.h>

namespace ironbird::hil_bridge::transport {

namespace {

/// Newer than some headers: the counters in the last two bytes count.
constexpr std::uint32_t kCounters = 0x200;
/// The controller is active again.
constexpr std::uint8_t kActiveAgain = 0x40;
constexpr std::size_t kControllerByte = 1;
constexpr std::size_t kPlaceByte = 3;
constexpr std::size_t kSendCounterByte = 6;
constexpr std::size_t kReceiveCounterByte = 7;

bool has(std::uint32_t value, std::uint32_t bits) {
  return (value & bits) != 0;
}

}  // namespace

ErrorEvents events_of(const CanFrame& error, Time stamp) {
  const std::uint32_t classes = error.identifier;
  const std::uint8_t controller = has(classes, CAN_ERR_CRTL) ? error.data[kControllerByte] : std::uint8_t{0};
  const bool nobody = has(classes, CAN_ERR_ACK) ||
                      (has(classes, CAN_ERR_PROT) && error.data[kPlaceByte] == CAN_ERR_PROT_LOC_ACK);
  BusEvent event;
  event.stamp = stamp;
  // Drivers older than the bit fill the counters in all the same; without them they are zero.
  if (has(classes, kCounters) || has(classes, CAN_ERR_CRTL | CAN_ERR_BUSERROR)) {
    event.send_errors = error.data[kSendCounterByte];
    event.receive_errors = error.data[kReceiveCounterByte];
  }
  ErrorEvents events;
  const auto report = [&](bool happened, BusEventKind kind, std::uint32_t count = 0) {
    if (!happened) return;
    event.kind = kind;
    event.count = count;
    events.push(event);
  };
  report(has(classes, CAN_ERR_RESTARTED), BusEventKind::kRestarted);
  report(has(classes, CAN_ERR_TX_TIMEOUT), BusEventKind::kSendTimeout);
  report(nobody, BusEventKind::kNoAcknowledge);
  report(!nobody && has(classes, CAN_ERR_PROT | CAN_ERR_BUSERROR), BusEventKind::kBusError);
  report(has(controller, CAN_ERR_CRTL_RX_OVERFLOW), BusEventKind::kLost, 1);
  report(has(controller, kActiveAgain), BusEventKind::kActive);
  report(has(controller, CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING), BusEventKind::kWarning);
  report(has(controller, CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE), BusEventKind::kPassive);
  report(has(classes, CAN_ERR_BUSOFF), BusEventKind::kOff);
  return events;
}

std::optional<BusState> state_after(BusEventKind kind) {
  switch (kind) {
    case BusEventKind::kActive:
    case BusEventKind::kRestarted:
      return BusState::kActive;
    case BusEventKind::kWarning:
      return BusState::kWarning;
    case BusEventKind::kPassive:
      return BusState::kPassive;
    case BusEventKind::kOff:
      return BusState::kOff;
    case BusEventKind::kDown:
    case BusEventKind::kGone:
      return BusState::kDown;
    default:
      return std::nullopt;
  }
}

}  // namespace ironbird::hil_bridge::transport
