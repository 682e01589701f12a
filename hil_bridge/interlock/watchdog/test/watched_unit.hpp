#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "hil_bridge/interlock/interlock.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"
#include "hil_bridge/serial_fcu/test/served_unit.hpp"
#include "hil_bridge/transport/byte_stream.hpp"
#include "hil_bridge/transport/file_descriptor.hpp"

// An armed unit at the end of a line, in real time, and a bench in another process that commands it.

namespace ironbird::hil_bridge::test {

/// The unit's end of the line; remembers which motor commands came.
class TappedLine final : public transport::ByteStream {
 public:
  explicit TappedLine(transport::ByteStream& line) : line_(line) {}
  std::size_t read(std::span<std::uint8_t> to) override {
    const std::size_t count = line_.read(to);
    decoder_.push(to.first(count), [&](const rosflight::Frame& frame) {
      const auto* command = std::get_if<rosflight::OffboardControl>(&frame.message);
      if (command == nullptr) {
        ++others;
      } else if (command->u == rosflight::OffboardControl{}.u && command->ignore == 0) {
        ++zeros;
      } else {
        ++thrusts;
      }
    });
    return count;
  }
  std::size_t write(std::span<const std::uint8_t> from) override { return line_.write(from); }
  bool is_up() const override { return line_.is_up(); }
  bool reopen() override { return line_.reopen(); }
  int descriptor() const override { return line_.descriptor(); }
  std::string name() const override { return line_.name(); }

  int zeros = 0;
  int thrusts = 0;
  int others = 0;

 private:
  transport::ByteStream& line_;
  rosflight::StreamDecoder decoder_;
};

/// A quadrotor with a mixer in fractions of full thrust, whose radio has an arm switch and an override
/// switch.
inline VirtualFcuConfig quadrotor() {
  VirtualFcuConfig config;
  config.parameters = {{"PRIMARY_MIXER", 2}, {"FAILSAFE_THR", 0.2}, {"RC_NUM_CHN", 8}, {"RC_ARM_CHN", 5}};
  return config;
}

/// Throttle stick of the pilot while the companion flies, and what the motors do then: RC_MAX_THR of it.
inline constexpr double kPilotsThrottle = 0.4;
inline constexpr double kPilotsMotors = 0.7 * kPilotsThrottle;
inline constexpr double kIdleMotors = 0.1;  // MOTOR_IDLE_THR
inline constexpr double kBenchsMotors = 0.5;

/// The unit, armed and handed over to the companion, in real time from then on.
class WatchedUnit {
 public:
  static constexpr Time kTick = std::chrono::microseconds(2500);

  explicit WatchedUnit(transport::ByteStream& stream)
      : line(stream), unit_(quadrotor()), served_(unit_, line) {
    // The first seconds, in which it calibrates, may go as fast as they like.
    const auto hurry = [&](double seconds) {
      for (int k = 0; k < static_cast<int>(seconds / 0.0025); ++k) tick();
    };
    hurry(4.0);
    pilot().arm(true);
    hurry(1.0);
    pilot().override_companion(false);
    pilot().set_stick(Stick::kThrottle, kPilotsThrottle);
    hurry(1.5);
    next_ = std::chrono::steady_clock::now();
  }

  /// Lets real time pass until `holds`. @return the time on the unit's clock that it took, or the limit
  Time until(Time limit, const std::function<bool()>& holds) {
    const Time began = now_;
    while (now_ - began < limit && !holds()) {
      tick();
      next_ += kTick;
      std::this_thread::sleep_until(next_);
    }
    return now_ - began;
  }
  void pass(Time duration) {
    until(duration, [] { return false; });
  }

  double motor() const { return unit_.host().commands().throttle[0]; }
  bool armed() { return unit_.host().firmware().arming().armed(); }
  RcPilot& pilot() { return unit_.host().pilot(); }

  TappedLine line;

 private:
  void tick() {
    served_.take();
    unit_.advance(now_ += kTick);
    served_.give();
  }

  DeskUnit unit_;
  ServedFcu served_;
  Time now_{};
  std::chrono::steady_clock::time_point next_;
};

/// The process of guarded_bench.cpp.
class BenchProcess {
 public:
  /// @param address  the device of a serial line, or udp:PORT:PORT, its own and the unit's
  BenchProcess(const std::string& address, InterlockProfile profile, bool gate_open = true) {
    std::array<int, 2> out{};
    std::array<int, 2> error{};
    if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(error.data(), O_CLOEXEC) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      dup2(out[1], STDOUT_FILENO);
      dup2(error[1], STDERR_FILENO);
      execl(GUARDED_BENCH, "guarded_bench", address.c_str(),
            profile == InterlockProfile::kFlight ? "flight" : "bench", gate_open ? "open" : "closed",
            nullptr);
      _exit(127);
    }
    out_ = transport::FileDescriptor(out[0]);
    error_ = transport::FileDescriptor(error[0]);
    close(out[1]);
    close(error[1]);
    const std::string first = line_of(out_);
    watchdog_ = first.empty() ? -1 : std::stoi(first);
  }
  ~BenchProcess() {
    if (process_ > 0) ::kill(process_, SIGKILL);
    end();
  }

  void signal(int number) const { ::kill(process_, number); }
  pid_t watchdog() const { return watchdog_; }
  /// One that has ended but that nobody has asked about yet does not live: who inherits it may take a second.
  bool watchdog_lives() const {
    std::ifstream stream("/proc/" + std::to_string(watchdog_) + "/stat");
    std::string number, name;
    char state = 'Z';
    stream >> number >> name >> state;
    return state != 'Z' && state != 'X';
  }
  /// Time that the watchdog has had a core for; nothing when it has gone.
  std::optional<double> watchdogs_cpu_seconds() const {
    std::ifstream stream("/proc/" + std::to_string(watchdog_) + "/stat");
    constexpr int kUserTime = 13;  // fields before it, see proc(5)
    std::string skipped;
    for (int k = 0; k < kUserTime; ++k) stream >> skipped;
    double user = 0.0, system = 0.0;
    if (!(stream >> user >> system)) return std::nullopt;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  /// Has it ended, and how? As waitpid says; nothing while it lives.
  std::optional<int> ended() {
    int status = 0;
    if (process_ > 0 && waitpid(process_, &status, WNOHANG) == process_) {
      process_ = -1;
      status_ = status;
    }
    return status_;
  }
  void end() {
    if (process_ > 0) waitpid(process_, nullptr, 0);
    process_ = -1;
  }
  std::string said() { return line_of(out_); }
  /// All that bench and watchdog wrote to standard error, once both have ended.
  std::string complaints() {
    std::string text;
    std::array<char, 1024> part{};
    for (ssize_t n = 0; (n = read(error_.number(), part.data(), part.size())) > 0;)
      text.append(part.data(), static_cast<std::size_t>(n));
    return text;
  }

 private:
  static std::string line_of(const transport::FileDescriptor& file) {
    std::string line;
    for (char letter = 0; read(file.number(), &letter, 1) == 1 && letter != '\n';) line += letter;
    return line;
  }

  pid_t process_ = -1;
  pid_t watchdog_ = -1;
  std::optional<int> status_;
  transport::FileDescriptor out_;
  transport::FileDescriptor error_;
};

}  // namespace ironbird::hil_bridge::test
