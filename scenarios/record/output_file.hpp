#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "scenarios/config/user_error.hpp"
#include "scenarios/record/background_writer.hpp"

namespace ironbird::scenarios {

/// A file that could be made could not be written to its end, as on a full disk.
class WriteError : public UserError {
 public:
  using UserError::UserError;
};

/// A file that is written from front to back, one system call per write. Does not buffer, unless its writing
/// is done in the background: then a write costs no system call, and what the disk cannot follow is left out,
/// each write wholly or not at all.
///
/// After a failed write the file is cut back to what was written before, and later writes do nothing: the
/// failure is reported once.
class OutputFile {
 public:
  /// Makes the file, or empties it. @throws std::runtime_error with path and reason
  explicit OutputFile(const std::filesystem::path& path, bool in_background = false);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Writes the runs of bytes one behind the other. @return are they part of the file?
  /// @throws WriteError with path and reason; in the background never
  bool write(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second = {});

  /// Closes the file. @throws WriteError when the system reports a write that failed late
  void close();

  std::uint64_t size() const { return size_; }
  bool failed() const { return failed_; }
  /// Bytes left out.
  std::uint64_t lost() const { return lost_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t lost_ = 0;
  bool failed_ = false;
  std::unique_ptr<BackgroundWriter> background_;
};

}  // namespace ironbird::scenarios
