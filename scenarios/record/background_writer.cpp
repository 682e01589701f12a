#include "scenarios/record/background_writer.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace ironbird::scenarios {

namespace {

constexpr std::chrono::milliseconds kLook{10};
constexpr std::chrono::milliseconds kToDisk{100};

}  // namespace

BackgroundWriter::BackgroundWriter(int descriptor)
    : descriptor_(descriptor), ring_(kRoom), thread_([this] { run(); }) {}

bool BackgroundWriter::put(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second) {
  const std::uint64_t at = put_.load(std::memory_order_relaxed);
  const std::uint64_t held = at - written_.load(std::memory_order_acquire);
  if (held + first.size() + second.size() > kRoom) return false;
  copy_in(first, at);
  copy_in(second, at + first.size());
  put_.store(at + first.size() + second.size(), std::memory_order_release);
  return true;
}

void BackgroundWriter::copy_in(std::span<const std::uint8_t> bytes, std::uint64_t at) {
  const std::size_t place = at % kRoom;
  const std::size_t part = std::min(bytes.size(), kRoom - place);
  if (part > 0) std::memcpy(ring_.data() + place, bytes.data(), part);
  if (bytes.size() > part) std::memcpy(ring_.data(), bytes.data() + part, bytes.size() - part);
}

int BackgroundWriter::finish() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
  return error();
}

void BackgroundWriter::run() {
  auto synced = std::chrono::steady_clock::now();
  bool fresh = false;
  for (;;) {
    const bool last = ending_;
    while (write_some() > 0) fresh = true;
    const auto now = std::chrono::steady_clock::now();
    if (fresh && (last || now - synced >= kToDisk)) {
      fdatasync(descriptor_);
      synced = now;
      fresh = false;
    }
    if (last) return;
    std::this_thread::sleep_for(kLook);
  }
}

std::size_t BackgroundWriter::write_some() {
  const std::uint64_t from = written_.load(std::memory_order_relaxed);
  const std::uint64_t waiting = put_.load(std::memory_order_acquire) - from;
  if (waiting == 0) return 0;
  const std::size_t place = from % kRoom;
  const std::size_t part = std::min<std::uint64_t>(waiting, kRoom - place);
  // After a failure what comes is taken and dropped: nobody is to wait for a full disk.
  ssize_t count = static_cast<ssize_t>(part);
  if (error() == 0) count = ::write(descriptor_, ring_.data() + place, part);
  if (count < 0) {
    if (errno != EINTR) error_ = errno;
    return 1;  // look again: to try anew, or to drop
  }
  written_.store(from + static_cast<std::uint64_t>(count), std::memory_order_release);
  return static_cast<std::size_t>(count);
}

}  // namespace ironbird::scenarios
