#include "scenarios/record/output_file.hpp"

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "scenarios/config/write_file.hpp"

namespace ironbird::scenarios {
namespace {

WriteError failure(const std::filesystem::path& path, const char* what, int reason) {
  return WriteError(with_remedy(path.string() + ": " + what + ": " + std::strerror(reason)));
}

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path, bool in_background) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw UserError(failure(path_, "cannot be made", errno));
  if (in_background) background_ = std::make_unique<BackgroundWriter>(descriptor_);
}

OutputFile::~OutputFile() {
  background_.reset();
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool OutputFile::write(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second) {
  if (failed_) return false;
  std::uint64_t written = 0;
  const std::uint64_t wanted = first.size() + second.size();
  if (background_) {
    const bool taken = background_->put(first, second);
    (taken ? size_ : lost_) += wanted;
    return taken;
  }
  while (written < wanted) {
    const auto of_first = first.subspan(std::min<std::uint64_t>(written, first.size()));
    const auto of_second = second.subspan(written > first.size() ? written - first.size() : 0);
    const std::array<iovec, 2> parts{iovec{const_cast<std::uint8_t*>(of_first.data()), of_first.size()},
                                     iovec{const_cast<std::uint8_t*>(of_second.data()), of_second.size()}};
    const ssize_t count = ::writev(descriptor_, parts.data(), static_cast<int>(parts.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int reason = count < 0 ? errno : ENOSPC;
      failed_ = true;
      // What is on the disk of the unfinished write is of no use; a file that cannot be cut stays as it is.
      [[maybe_unused]] const int cut = ::ftruncate(descriptor_, static_cast<off_t>(size_));
      throw failure(path_, "writing failed", reason);
    }
    written += static_cast<std::uint64_t>(count);
  }
  size_ += wanted;
  return true;
}

void OutputFile::close() {
  if (descriptor_ < 0) return;
  const int failed_write = background_ ? background_->finish() : 0;
  background_.reset();
  const int result = ::close(descriptor_);
  const int reason = errno;
  descriptor_ = -1;
  if (failed_write != 0) {
    failed_ = true;
    throw failure(path_, "writing failed", failed_write);
  }
  if (result != 0 && !failed_) {
    failed_ = true;
    throw failure(path_, "closing failed", reason);
  }
}

}  // namespace ironbird::scenarios
