#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace ironbird::hil_bridge {

/// Hands the latest of some values from one thread to another. Neither ever waits, nothing is allocated;
/// values in between are lost. Three places: one is written, one is read, one lies ready.
template <class T>
class LatestValue {
 public:
  /// The writer's. @param value  copied
  void write(const T& value) {
    places_[written_] = value;
    written_ =
        ready_.exchange(static_cast<std::uint8_t>(written_ | kFresh), std::memory_order_acq_rel) & kPlace;
  }

  /// The reader's: the latest value, which may be the one of the last call.
  const T& read() {
    if ((ready_.load(std::memory_order_relaxed) & kFresh) != 0) {
      read_ = ready_.exchange(read_, std::memory_order_acq_rel) & kPlace;
    }
    return places_[read_];
  }

 private:
  static constexpr std::uint8_t kPlace = 3;
  static constexpr std::uint8_t kFresh = 4;

  std::array<T, 3> places_{};
  std::uint8_t written_ = 0;
  std::uint8_t read_ = 1;
  std::atomic<std::uint8_t> ready_{2};
};

}  // namespace ironbird::hil_bridge
