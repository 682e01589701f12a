#pragma once

#include <string>
#include <vector>

#include "hil_bridge/transport/bounded_queue.hpp"
#include "hil_bridge/transport/frame_bus.hpp"

namespace ironbird::hil_bridge::transport {

/// Which interface of this machine, and what it has to be able to do.
struct SocketCanParams {
  std::string interface = "can0";
  bool fd = false;
  int bit_rate = 0;
  int receive_buffer = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("interface", self.interface, "", "name of the CAN interface");
    visit("fd", self.fd, "1", "CAN FD frames are sent and received");
    visit("bit_rate", self.bit_rate, "bit/s", "what the interface has to be set to, 0 for whatever it is", 0,
          1000000);
    visit("receive_buffer", self.receive_buffer, "byte",
          "room for frames not fetched yet, 0 for the system's choice", 0, 67108864);
  }
};

/// A CAN interface of this machine: a raw socket of Linux. Non-blocking. Stamps are the kernel's, moved to
/// the monotonic clock. Survives that the interface is switched off or unplugged, and takes it up again when
/// it is back.
///
/// Does not set the interface up: bit rate, restart after bus-off and switching on are the administrator's.
class SocketCan final : public FrameBus {
 public:
  /// @param epoch  reading of the monotonic clock that is time zero of the stamps
  /// @throws std::invalid_argument in one line with the remedy, when the kernel knows no CAN, when there is
  /// no such
  ///         interface or it is none for CAN, is down, or cannot do what is asked for.
  explicit SocketCan(const SocketCanParams& params, Time epoch = Time(0));
  ~SocketCan() override;
  SocketCan(const SocketCan&) = delete;
  SocketCan& operator=(const SocketCan&) = delete;

  bool send(const CanFrame& frame) override;
  std::optional<ReceivedFrame> receive() override;
  std::optional<BusEvent> take_event() override { return events_.pop(); }
  void set_filters(std::span<const FrameFilter> filters) override;
  BusState state() const override { return state_; }
  bool fd() const override { return params_.fd; }
  const BusCounters& counters() const override { return counters_; }

  /// To wait on with poll. Changes when the interface is plugged in again.
  int descriptor() const { return descriptor_; }

 private:
  struct Arrival;

  void open();
  void apply_filters() const;
  bool fetch(Arrival& arrival);
  void lost_interface(int error);
  void look_for_interface();
  void report(BusEventKind kind, std::uint32_t count = 0);
  void take_error(const CanFrame& frame, Time stamp);
  Time stamp_of(Time wall_clock);

  SocketCanParams params_;
  Time epoch_;
  std::vector<FrameFilter> filters_;
  BoundedQueue<BusEvent> events_;
  BusCounters counters_;
  BusState state_ = BusState::kActive;
  Time last_stamp_{0};
  std::uint32_t overflow_ = 0;
  int descriptor_ = -1;
  int index_ = 0;
  bool gone_ = false;
};

}  // namespace ironbird::hil_bridge::transport
