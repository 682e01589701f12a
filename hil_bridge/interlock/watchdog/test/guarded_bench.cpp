// A bench in small: a control loop that commands half thrust over a serial line, a second thread, and a
// watchdog over both. The test stops it, kills it and lets its threads deadlock.
//
//   guarded_bench DEVICE bench|flight open|closed
//
// SIGUSR1: the control loop deadlocks. SIGUSR2: the other thread does. SIGTERM: a clean end. Says on standard
// output, once, what it ended for.

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <span>
#include <string>
#include <thread>

#include "hil_bridge/interlock/watchdog/watchdog.hpp"
#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/transport/serial_port.hpp"

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

/// What the control loop does with the line: empties it, brings it up again, commands.
class Commander {
 public:
  Commander(const std::string& device, bool open, Watchdog& watchdog)
      : port_({device, 921600}), watchdog_(watchdog), open_(open) {
    port_.open();
    watchdog_.guard_line(port_.descriptor());
  }

  void pass() {
    if (!port_.is_up() && port_.reopen()) watchdog_.guard_line(port_.descriptor());
    std::array<std::uint8_t, 4096> bytes{};
    while (port_.read(bytes) > 0) {
    }
    watchdog_.gate_open(open_);
    if (!port_.is_up() || !open_) return;
    rosflight::OffboardControl half;
    half.u[2] = -0.5F;
    const auto frame = rosflight::encode_frame(half, sequence_++, {1, 50});
    port_.write(std::span(frame.bytes).first(frame.size));
  }

 private:
  transport::SerialPort port_;
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
  config.threads = {{"the control loop", milliseconds(50)}, {"the recorder", milliseconds(200)}};
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
