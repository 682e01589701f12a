// A bench in small: a control loop that commands half thrust over a line, a second thread, and a watchdog
// over both. The test stops it, kills it and lets its threads deadlock.
//
//   guarded_bench DEVICE bench|flight open|closed
//   guarded_bench udp:OWN_PORT:UNITS_PORT bench|flight open|closed
//
// SIGUSR1: the control loop deadlocks. SIGUSR2: the other thread does. SIGTERM: a clean end. Says on standard
// output, once, what it ended for.

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>

#include "hil_bridge/interlock/watchdog/watchdog.hpp"
#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/transport/serial_port.hpp"
#include "hil_bridge/transport/udp_socket.hpp"

namespace {

using namespace ironbird::hil_bridge;
using std::chrono::milliseconds;

volatile std::sig_atomic_t deadlock_control = 0;
volatile std::sig_atomic_t deadlock_other = 0;
volatile std::sig_atomic_t end_wanted = 0;

void deadlock() {
  static std::mutex mutex;
  mutex.lock();
  mutex.lock();
}

Time now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

std::unique_ptr<transport::ByteStream> open_line(const std::string& address) {
  transport::UdpConfig ports;
  if (std::sscanf(address.c_str(), "udp:%d:%d", &ports.local_port, &ports.port) == 2) {
    auto socket = std::make_unique<transport::UdpSocket>(ports);
    socket->open();
    return socket;
  }
  auto port = std::make_unique<transport::SerialPort>(transport::SerialPortConfig{address, 921600});
  port->open();
  return port;
}

/// What the control loop does with the line: empties it, brings it up again, commands.
class Commander {
 public:
  Commander(const std::string& address, bool open, Watchdog& watchdog)
      : line_(open_line(address)), watchdog_(watchdog), open_(open) {
    watchdog_.guard_line(line_->descriptor());
  }

  void pass() {
    if (!line_->is_up() && line_->reopen()) watchdog_.guard_line(line_->descriptor());
    std::array<std::uint8_t, 4096> bytes{};
    while (line_->read(bytes) > 0) {
    }
    watchdog_.gate_open(open_);
    if (!line_->is_up() || !open_) return;
    rosflight::OffboardControl half;
    half.u[2] = -0.5F;
    const auto frame = rosflight::encode_frame(half, sequence_++, {1, 50});
    line_->write(std::span(frame.bytes).first(frame.size));
  }

 private:
  std::unique_ptr<transport::ByteStream> line_;
  Watchdog& watchdog_;
  bool open_;
  std::uint8_t sequence_ = 0;
};

}  // namespace

int main(int, char** argv) {
  signal(SIGUSR1, [](int) { deadlock_control = 1; });
  signal(SIGUSR2, [](int) { deadlock_other = 1; });
  signal(SIGTERM, [](int) { end_wanted = 1; });
  WatchdogConfig config;
  config.profile = std::string(argv[2]) == "flight" ? InterlockProfile::kFlight : InterlockProfile::kBench;
  config.threads = {{"the control loop", milliseconds(50)}, {"the operator's thread", milliseconds(200)}};
  config.zeros_at_most = std::chrono::seconds(2);
  Watchdog watchdog(config);
  std::printf("%d\n", watchdog.process());
  std::fflush(stdout);
  std::atomic<bool> ended{false};
  std::thread other([&] {
    while (!ended) {
      if (deadlock_other != 0) deadlock();
      watchdog.pulse(1).beat();
      std::this_thread::sleep_for(milliseconds(10));
    }
    watchdog.pulse(1).rest();
  });
  const char* why = "leave";
  Commander commander(argv[1], std::string(argv[3]) == "open", watchdog);
  while (end_wanted == 0) {
    if (deadlock_control != 0) deadlock();
    watchdog.pulse(0).beat();
    if (!watchdog.watching(now())) {
      why = "the watchdog is gone";
      break;
    }
    commander.pass();
    std::this_thread::sleep_for(milliseconds(5));
  }
  ended = true;
  other.join();
  watchdog.leave();
  std::puts(why);
  return 0;
}
