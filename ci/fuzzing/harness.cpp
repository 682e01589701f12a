#include "ci/fuzzing/harness.hpp"

#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace ironbird::fuzzing {

namespace {

/// How much has been checked. libFuzzer counts inputs, a promise is made in bytes.
class Ledger {
 public:
  Ledger() {
    if (const char* const limit = std::getenv("IRONBIRD_FUZZ_BYTES"))
      limit_ = std::strtoull(limit, nullptr, 10);
  }
  ~Ledger() { say(); }
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  void note(std::size_t size) {
    bytes_ += size;
    ++inputs_;
    if (limit_ != 0 && bytes_ >= limit_) {
      say();
      _exit(0);  // libFuzzer takes any other end for a finding
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - said_ < std::chrono::seconds(2)) return;
    said_ = now;
    say();
  }

 private:
  void say() const {
    std::fprintf(stderr, "checked %llu bytes in %llu inputs\n", bytes_, inputs_);
    std::fflush(stderr);
  }

  unsigned long long limit_ = 0;
  unsigned long long bytes_ = 0;
  unsigned long long inputs_ = 0;
  std::chrono::steady_clock::time_point said_ = std::chrono::steady_clock::now();
};

/// Ends the program at an input that takes too much of a core. libFuzzer itself looks at the clock only, and
/// on a machine that does other things many seconds pass for nothing.
class CoreTime {
 public:
  CoreTime() {
    struct sigaction action {};
    action.sa_handler = [](int) { tick(); };
    action.sa_flags = SA_RESTART;
    const itimerval every_second{{1, 0}, {1, 0}};
    require(sigaction(SIGPROF, &action, nullptr) == 0 && setitimer(ITIMER_PROF, &every_second, nullptr) == 0,
            "the time of a core can be measured");
  }
  void begin() { seconds_ = 0; }

 private:
  static constexpr int kMost = 10;  // s, with the sanitizers; inputs take some milliseconds

  static void tick() {
    seconds_ = seconds_ + 1;
    if (seconds_ <= kMost) return;
    constexpr std::string_view kSays = "does not hold: an input takes a few seconds of a core at most\n";
    (void)!::write(STDERR_FILENO, kSays.data(), kSays.size());
    std::abort();  // libFuzzer then keeps the input
  }

  static inline volatile std::sig_atomic_t seconds_ = 0;
};

}  // namespace

void require(bool holds, const char* property) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", property);
  std::abort();
}

void require(bool holds, const std::string& property) {
  require(holds, property.c_str());
}

std::uint8_t Choices::byte() {
  if (rest_.empty()) return 0;
  const std::uint8_t first = rest_.front();
  rest_ = rest_.subspan(1);
  return first;
}

std::span<const std::uint8_t> Choices::take(std::size_t count) {
  const auto taken = rest_.first(std::min(count, rest_.size()));
  rest_ = rest_.subspan(taken.size());
  return taken;
}

MemoryFile::MemoryFile()
    : descriptor_(memfd_create("input", 0)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {
  require(descriptor_ >= 0, "there is room for a file in memory");
}

MemoryFile::~MemoryFile() {
  close(descriptor_);
}

void MemoryFile::write(std::span<const std::uint8_t> content) const {
  const bool whole = ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, content.data(), content.size(),
                                                              0) == static_cast<ssize_t>(content.size());
  require(whole, "a file in memory can be written");
}

void MemoryFile::write(const std::string& content) const {
  write(std::span(reinterpret_cast<const std::uint8_t*>(content.data()), content.size()));
}

}  // namespace ironbird::fuzzing

/// libFuzzer's door.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static ironbird::fuzzing::Ledger ledger;
  static ironbird::fuzzing::CoreTime core_time;
  core_time.begin();
  ironbird::fuzzing::check({data, size});
  ledger.note(size);
  return 0;
}
