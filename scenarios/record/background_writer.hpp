#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

namespace ironbird::scenarios {

/// Takes bytes without ever waiting, and has a thread write them to a file and the file to the disk.
///
/// One thread puts, with no lock, allocation or system call; the writer looks every few milliseconds. What
/// does not fit is refused as a whole.
class BackgroundWriter {
 public:
  static constexpr std::size_t kRoom = std::size_t{1} << 23;  ///< bytes: a minute of a log of a flight

  /// @param descriptor  open for writing; outlives this
  explicit BackgroundWriter(int descriptor);
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;
  ~BackgroundWriter() { finish(); }

  /// @return were all taken? Otherwise none
  bool put(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second);

  /// Waits until all is written. Nothing may be put afterwards. @return errno of the write that failed, or 0
  int finish();

  /// errno of the write that failed, or 0.
  int error() const { return error_.load(std::memory_order_relaxed); }

 private:
  void run();
  /// @return bytes written
  std::size_t write_some();
  void copy_in(std::span<const std::uint8_t> bytes, std::uint64_t at);

  int descriptor_;
  std::vector<std::uint8_t> ring_;
  std::atomic<std::uint64_t> put_{0};
  std::atomic<std::uint64_t> written_{0};
  std::atomic<int> error_{0};
  std::atomic<bool> ending_{false};
  std::jthread thread_;
};

}  // namespace ironbird::scenarios
