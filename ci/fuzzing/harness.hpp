#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// What the fuzz targets of all rooms share. A target is one file that defines `check`.

namespace ironbird::fuzzing {

/// Looks whether the target's property holds for this input. Called once for each input; must not remember.
void check(std::span<const std::uint8_t> input);

/// Part of a property. When it does not hold, says so and ends the program, and the input is kept as a
/// finding.
void require(bool holds, const char* property);
void require(bool holds, const std::string& property);

/// Reads an input as a sequence of choices; behind its end every choice is 0.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> input) : rest_(input) {}

  bool any_left() const { return !rest_.empty(); }
  std::uint8_t byte();
  /// Little endian, `sizeof(T)` bytes.
  template <class T>
  T number() {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < sizeof(T); ++k) bits |= static_cast<std::uint64_t>(byte()) << (8U * k);
    return static_cast<T>(bits);
  }
  std::size_t below(std::size_t count) { return number<std::uint16_t>() % count; }
  bool flag() { return (byte() & 1U) != 0; }
  /// At most `count` of the bytes that are left.
  std::span<const std::uint8_t> take(std::size_t count);

 private:
  std::span<const std::uint8_t> rest_;
};

/// A file that exists in memory only, for readers that want a path.
class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void write(std::span<const std::uint8_t> content) const;
  void write(const std::string& content) const;
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

}  // namespace ironbird::fuzzing
