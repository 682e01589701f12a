#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hil_bridge/interlock/interlock.hpp"
#include "hil_bridge/transport/file_descriptor.hpp"

namespace ironbird::hil_bridge {

/// A thread of the bench that may not fall silent.
struct GuardedThread {
  std::string name;
  Time limit{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "for the operator");
    visit("limit", self.limit, "ns", "longest time between two beats");
  }
};

/// What a watchdog guards, and what it does when it bites.
struct WatchdogConfig {
  InterlockProfile profile = InterlockProfile::kBench;
  std::vector<GuardedThread> threads;
  Time look = std::chrono::milliseconds(2);
  Time zero_period = std::chrono::milliseconds(10);
  Time zeros_at_most = std::chrono::seconds(10);

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("profile", self.profile, "1", "zeros after a bite, or silence");
    visit("threads", self.threads, "", "at most eight");
    visit("look", self.look, "ns", "between two looks at the beats");
    visit("zero_period", self.zero_period, "ns", "between two zero commands");
    visit("zeros_at_most", self.zeros_at_most, "ns", "end of the zeros, when the unit does not say disarmed");
  }
};

struct SharedBeats;

/// What a guarded thread holds: each beat is one store into memory that the watchdog reads, no system call.
/// Guarded from the first beat until `rest`.
class Pulse {
 public:
  void beat() { cell_->store(++count_, std::memory_order_relaxed); }
  /// From here on the thread may be silent, until it beats again.
  void rest() { cell_->store(0, std::memory_order_relaxed); }

 private:
  friend class Watchdog;
  std::atomic<std::uint64_t>* cell_ = nullptr;
  std::uint64_t count_ = 0;
};

/// A process of its own beside the bench, which ends it when it is stopped, stuck or dead: docs/safety.md,
/// R8.
///
/// It kills the bench first, so that nothing continues later with old commands; then it sends zero thrust
/// over the bench's line (profile `bench`) or nothing (profile `flight`). It never sends anything else, never
/// arms, and keeps its hands off a bench that beats.
class Watchdog {
 public:
  static constexpr std::size_t kMostThreads = 8;
  /// Silence of the watchdog itself after which the bench must not rely on it.
  static constexpr Time kOwnLimit = std::chrono::milliseconds(50);

  /// Starts the process. Call it before the first thread: a process with threads cannot be copied safely.
  /// @throws std::runtime_error when there are threads already, or the system refuses
  explicit Watchdog(const WatchdogConfig& config);
  /// Without `leave` before it, the bench has failed: the watchdog sends its zeros, but kills nobody.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Of the thread with this number in the configuration; used by that thread only.
  Pulse& pulse(std::size_t thread) { return pulses_.at(thread); }

  /// Hands the watchdog the line's descriptor, as often as the line is opened. Not in the step.
  /// @return has it been handed over?
  bool guard_line(int descriptor);

  /// Is the gate open for motor commands, be they zeros? Told in every pass, no system call. While it is not,
  /// nothing is sent after a bite either: the unit is somebody else's, perhaps in the air.
  void gate_open(bool open);

  /// Is the watchdog there and awake? Asked by the control loop in every pass; a bench that hears no kills.
  bool watching(Time now);

  /// Could it get a priority above every other process? Else a machine that is busy may let it wait.
  bool has_priority() const;
  pid_t process() const { return process_; }

  /// A clean end: the gate is closed, the unit has been told. The watchdog ends and says nothing.
  void leave();

 private:
  void start(const WatchdogConfig& config);
  void wait_until_awake();
  void dismiss(char word);
  void see_off();

  SharedBeats* shared_ = nullptr;
  std::vector<Pulse> pulses_;
  transport::FileDescriptor socket_;
  pid_t process_ = -1;
  std::uint64_t heard_ = 0;
  Time heard_at_ = Time::min();
};

}  // namespace ironbird::hil_bridge
