#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace ironbird::scenarios {

/// A file that is written from front to back, one system call per write. Does not buffer.
///
/// After a failed write the file is cut back to what was written before, and later writes do nothing: the
/// failure is reported once.
class OutputFile {
 public:
  /// Makes the file, or empties it. @throws std::runtime_error with path and reason
  explicit OutputFile(const std::filesystem::path& path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Writes the runs of bytes one behind the other. @throws std::runtime_error with path and reason
  void write(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second = {});

  /// Closes the file. @throws std::runtime_error when the system reports a write that failed late
  void close();

  std::uint64_t size() const { return size_; }
  bool failed() const { return failed_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  bool failed_ = false;
};

}  // namespace ironbird::scenarios
