#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hil_bridge/transport/frame_bus.hpp"

namespace ironbird::hil_bridge::transport {

/// Speed, queues and noise of a bus in this process.
struct InProcessBusParams {
  double bit_rate = 1.0e6;
  bool fd = false;
  double data_bit_rate = 4.0e6;
  double corruption = 0.0;
  double loss = 0.0;
  std::uint64_t seed = 1;
  Time restart_delay{0};
  int send_queue = 64;
  int receive_queue = 256;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("bit_rate", self.bit_rate, "bit/s", "of classic frames and of the head of CAN FD frames", 1.0e4,
          1.0e6);
    visit("fd", self.fd, "1", "the bus carries CAN FD frames");
    visit("data_bit_rate", self.data_bit_rate, "bit/s", "of the data of CAN FD frames", 1.0e4, 8.0e6);
    visit("corruption", self.corruption, "1", "probability that noise breaks a frame, which is then repeated",
          0.0, 1.0);
    visit("loss", self.loss, "1", "probability that one receiver misses a frame and nobody notices", 0.0,
          1.0);
    visit("seed", self.seed, "1", "of the noise");
    visit("restart_delay", self.restart_delay, "ns",
          "from bus-off to the controller's restart, 0 never by itself");
    visit("send_queue", self.send_queue, "1", "frames that one end can have waiting", 1, 100000);
    visit("receive_queue", self.receive_queue, "1", "frames that one end keeps until they are fetched", 1,
          100000);
  }
};

/// A CAN bus without a kernel and without a clock: frames take the time that they take on a wire, the lower
/// identifier goes first, a broken frame is repeated, and controllers count errors up to error-passive and
/// bus-off as the standard says. Same calls, same frames at the same times.
///
/// Stuff bits are not counted: a frame of eight bytes takes 131 bit times, on a wire 131 to 160. Two ends
/// that send the same identifier at the same time do not collide: the one attached first goes first.
class InProcessBus {
 public:
  /// @throws std::invalid_argument when a parameter is outside its bounds.
  explicit InProcessBus(const InProcessBusParams& params = {});
  ~InProcessBus();

  /// One more end. It lives as long as the bus.
  FrameBus& attach();

  /// Lets time pass: everything that ends up to then has happened.
  /// @param until  not before the last call's
  void advance(Time until);

  /// The next frames are broken by noise, whoever sends them, and repeated.
  void corrupt_next(int frames) { corrupt_next_ = frames; }
  /// The next frames arrive nowhere, and nobody notices.
  void lose_next(int frames) { lose_next_ = frames; }
  /// Every frame breaks while the wires touch.
  void short_circuit(bool wires_touch) { shorted_ = wires_touch; }
  /// An end without its plug sends to nobody and hears nothing. @throws std::invalid_argument for an end of
  /// another bus
  void plug(FrameBus& end, bool in);
  /// Restarts a controller that is off.
  void restart(FrameBus& end);

 private:
  class End;

  End& find(FrameBus& end);
  End* winner() const;
  void finish(Time stamp);
  void fail(End& sender, BusEventKind cause, Time stamp);
  void deliver(const End& sender, const CanFrame& frame, Time stamp);
  void restart_due(Time now);
  Time duration(const CanFrame& frame) const;
  double chance();

  InProcessBusParams params_;
  std::vector<std::unique_ptr<End>> ends_;
  End* sending_ = nullptr;
  Time now_{0};
  Time free_at_{0};
  std::uint64_t dice_;
  int corrupt_next_ = 0;
  int lose_next_ = 0;
  bool shorted_ = false;
};

}  // namespace ironbird::hil_bridge::transport
