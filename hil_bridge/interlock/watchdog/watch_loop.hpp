#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "hil_bridge/interlock/watchdog/watchdog.hpp"
#include "hil_bridge/interlock/watchdog/zero_sender.hpp"
#include "hil_bridge/transport/file_descriptor.hpp"

namespace ironbird::hil_bridge {

/// The memory that bench and watchdog share. Each counter has a cache line of its own, so that threads do not
/// wait for each other's beats.
struct SharedBeats {
  static constexpr std::size_t kCacheLine = 64;
  struct alignas(kCacheLine) Cell {
    std::atomic<std::uint64_t> beats{0};
  };
  Cell watchdog;
  Cell priority;   // 1: it got one
  Cell gate_open;  // 1: motor commands leave
  std::array<Cell, Watchdog::kMostThreads> threads;
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// What the bench says to its watchdog, besides the descriptor of a line.
inline constexpr char kLeave = 'L';
inline constexpr char kAbandon = 'A';
inline constexpr char kNewLine = 'N';

/// The watchdog's side, from the moment that its process exists. One thread, nothing that waits for others.
class WatchLoop {
 public:
  /// @param bench  a pidfd of the bench  @param socket  the watchdog's end of the talk with it
  WatchLoop(SharedBeats& shared, const WatchdogConfig& config, transport::FileDescriptor bench,
            transport::FileDescriptor socket);

  /// Watches until the bench takes leave, or until it has bitten and all is done.
  void run();

 private:
  void take_orders();
  void drop_dead_line(Time now);
  bool gate_open() const;
  bool bench_gone(int patience_ms) const;
  /// What is wrong with a thread, or nothing.
  std::optional<std::string> silence(Time now);
  void bite(const std::string& why, bool kill);
  void finish_with_zeros(const std::string& what_happened);

  struct Watched {
    std::uint64_t beats = 0;
    Time changed{};
  };

  SharedBeats& shared_;
  const WatchdogConfig& config_;
  transport::FileDescriptor bench_;
  transport::FileDescriptor socket_;
  ZeroSender line_;
  std::array<Watched, Watchdog::kMostThreads> watched_{};
  Time line_seen_{};
  bool left_ = false;
  bool abandoned_ = false;
};

/// Turns a fresh copy of the bench into a process that nothing of the bench's life reaches: own session, no
/// signals, no files but these two and standard error, a priority above all others where it is permitted.
/// @return did it get the priority?
bool stand_apart(int bench, int socket);

}  // namespace ironbird::hil_bridge
