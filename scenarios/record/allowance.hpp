#pragma once

#include <cstdint>
#include <string>

namespace ironbird::scenarios {

/// How much memory the reader of a log may still fill with what the log says.
///
/// A few bytes can stand for very many: compressed zeros, arrays of arrays, a row of columns that are all
/// absent. So there is a bound that grows with the file. A flight needs a hundredth of it.
class Allowance {
 public:
  /// @param file_size  of the log, bytes
  explicit Allowance(std::uint64_t file_size) : file_size_(file_size), left_(whole()) {}

  /// Uses up so many bytes. @return false when there are not so many, and then nothing is used
  [[nodiscard]] bool take(std::uint64_t bytes) {
    if (bytes > left_) return false;
    left_ -= bytes;
    return true;
  }

  /// The end of a sentence that says what does not fit.
  std::string refusal() const {
    return "more than " + std::to_string(whole() >> 20U) + " MiB in memory, too much for a file of " +
           std::to_string(file_size_) + " bytes";
  }

 private:
  std::uint64_t whole() const { return (std::uint64_t{16} << 20U) + 256 * file_size_; }

  std::uint64_t file_size_;
  std::uint64_t left_;
};

}  // namespace ironbird::scenarios
