#include "scenarios/app/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "scenarios/config/user_error.hpp"
#include "scenarios/config/write_file.hpp"

namespace ironbird::scenarios {

namespace {

/// Runs that end just now remove their empty folder; a name that never leads to the folder made is of a file
/// system on which nothing can be held.
constexpr int kMostTries = 100;

}  // namespace

RunFolder::RunFolder(std::filesystem::path path) : path_(std::move(path)) {
  for (int tried = 0; tried < kMostTries; ++tried) {
    make_folder(path_);
    if (hold()) return;
  }
}

RunFolder::~RunFolder() {
  // While it is held, since another run may be about to take it; and by its name only where that is still its
  // name.
  std::error_code not_empty;
  if (is_named()) std::filesystem::remove(path_, not_empty);
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool RunFolder::hold() {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) return errno != ENOENT;  // one that may not be read may still be written to
  const bool taken = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  const bool named = is_named();
  if (named && !taken) return true;
  ::close(std::exchange(descriptor_, -1));
  if (!named) return false;  // the run before has just removed it
  throw UserError(path_.string() + ": another run is writing its results here; wait for its end, or choose " +
                  "another folder with --out");
}

bool RunFolder::is_named() const {
  struct stat held {};
  struct stat named {};
  return ::fstat(descriptor_, &held) == 0 && ::stat(path_.c_str(), &named) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

void remove_old_products(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const char* name : {"verdict.json", "report.html", "flight.mcap", "video.mp4"}) {
    std::filesystem::remove(folder / name, ignored);
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder / "snapshots", ignored)) {
    if (entry.path().extension() == ".png") std::filesystem::remove(entry.path(), ignored);
  }
}

}  // namespace ironbird::scenarios
