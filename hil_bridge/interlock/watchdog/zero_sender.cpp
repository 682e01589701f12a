#include "hil_bridge/interlock/watchdog/zero_sender.hpp"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <span>
#include <utility>
#include <variant>

#include "hil_bridge/interlock/command_check.hpp"

namespace ironbird::hil_bridge {

namespace {

constexpr rosflight::Address kCompanion{1, 50};
constexpr int kMostReads = 16;  // of 4096 bytes, at a time: a line that never ends must not end the zeros

}  // namespace

void ZeroSender::take_line(transport::FileDescriptor line) {
  line_ = std::move(line);
  decoder_.clear();
}

void ZeroSender::drop_if_dead() {
  if (!line_) return;
  pollfd state{line_.number(), 0, 0};
  if (poll(&state, 1, 0) > 0 && (state.revents & (POLLHUP | POLLNVAL)) != 0) line_.close();
}

void ZeroSender::discard_old() {
  if (!line_) return;
  tcflush(line_.number(), TCIOFLUSH);  // does nothing to a socket, whose datagrams are read away
  std::array<std::uint8_t, 4096> bytes{};
  for (int k = 0; k < kMostReads && read(line_.number(), bytes.data(), bytes.size()) > 0; ++k) {
  }
  decoder_.clear();
}

bool ZeroSender::send_zero() {
  if (!line_) return false;
  if (sent_ == frame_.size) {
    frame_ = rosflight::encode_frame(zero_command(), sequence_++, kCompanion);
    sent_ = 0;
  }
  const ssize_t count = write(line_.number(), frame_.bytes.data() + sent_, frame_.size - sent_);
  if (count > 0) sent_ += static_cast<std::size_t>(count);
  return count > 0;
}

bool ZeroSender::heard_disarmed() {
  if (!line_) return false;
  bool disarmed = false;
  std::array<std::uint8_t, 4096> bytes{};
  for (int k = 0; k < kMostReads; ++k) {
    const ssize_t count = read(line_.number(), bytes.data(), bytes.size());
    if (count <= 0) break;
    decoder_.push(std::span(bytes).first(static_cast<std::size_t>(count)),
                  [&](const rosflight::Frame& frame) {
                    const auto* status = std::get_if<rosflight::RosflightStatus>(&frame.message);
                    if (status != nullptr) disarmed = status->armed == 0;
                  });
  }
  return disarmed;
}

}  // namespace ironbird::hil_bridge
