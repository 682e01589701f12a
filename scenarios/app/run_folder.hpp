#pragma once

#include <filesystem>

namespace ironbird::scenarios {

/// The folder that one run writes its results to, held while the run goes on: two runs would spoil each
/// other's files.
///
/// Held by an advisory lock on the folder itself, which ends with the process, however it ends, and leaves no
/// file. A file system that has no such locks holds nothing.
class RunFolder {
 public:
  /// Makes the folder, and those above it. @throws UserError when it cannot be made, or another run holds it
  explicit RunFolder(std::filesystem::path path);
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  /// Lets go, and removes the folder when nothing was written.
  ~RunFolder();

 private:
  /// @return false: the folder was removed meanwhile. @throws UserError when another run holds it
  bool hold();
  /// Is the folder that is held still the one of this name?
  bool is_named() const;

  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Removes what an earlier run left in the folder: it must not be taken for this one's.
void remove_old_products(const std::filesystem::path& folder);

}  // namespace ironbird::scenarios
