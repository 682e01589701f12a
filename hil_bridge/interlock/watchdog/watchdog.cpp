#include "hil_bridge/interlock/watchdog/watchdog.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include "hil_bridge/interlock/watchdog/watch_loop.hpp"

namespace ironbird::hil_bridge {

namespace {

using transport::FileDescriptor;

constexpr int kWakingPatience = 2000;   // ms
constexpr int kPartingPatience = 1000;  // ms

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error("the watchdog cannot be started: " + what);
}

std::ptrdiff_t threads_of_this_process() {
  std::error_code error;
  const std::filesystem::directory_iterator tasks("/proc/self/task", error);
  return error ? 1 : std::distance(begin(tasks), end(tasks));
}

}  // namespace

Watchdog::Watchdog(const WatchdogConfig& config) {
  if (config.threads.size() > kMostThreads) refuse("more than eight threads to guard");
  for (const GuardedThread& thread : config.threads) {
    if (thread.limit <= Time::zero()) refuse(thread.name + ": limit must be > 0");
  }
  if (threads_of_this_process() != 1) refuse("there are threads already; start it before them");
  void* const memory =
      mmap(nullptr, sizeof(SharedBeats), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) refuse(std::strerror(errno));
  shared_ = new (memory) SharedBeats;
  pulses_.resize(config.threads.size());
  for (std::size_t k = 0; k < pulses_.size(); ++k) pulses_[k].cell_ = &shared_->threads[k].beats;
  start(config);
  wait_until_awake();
}

void Watchdog::start(const WatchdogConfig& config) {
  // Made before the fork: a number of a process could by then be somebody else's.
  FileDescriptor bench(static_cast<int>(syscall(SYS_pidfd_open, getpid(), 0)));
  std::array<int, 2> ends{};
  if (!bench || socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    refuse(std::strerror(errno));
  }
  socket_ = FileDescriptor(ends[0]);
  FileDescriptor other(ends[1]);
  process_ = fork();
  if (process_ < 0) refuse(std::strerror(errno));
  if (process_ > 0) return;
  const bool priority = stand_apart(bench.number(), other.number());
  shared_->priority.beats.store(priority ? 1 : 0, std::memory_order_relaxed);
  WatchLoop(*shared_, config, std::move(bench), std::move(other)).run();
  _exit(0);
}

void Watchdog::wait_until_awake() {
  for (int k = 0; k < kWakingPatience; ++k) {
    if (shared_->watchdog.beats.load(std::memory_order_relaxed) != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  dismiss(kLeave);
  refuse("its process does not answer");
}

Watchdog::~Watchdog() {
  dismiss(kAbandon);
  munmap(shared_, sizeof(SharedBeats));
}

bool Watchdog::guard_line(int descriptor) {
  char word = kNewLine;
  iovec part{&word, 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> room{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = room.data();
  message.msg_controllen = room.size();
  cmsghdr* const extra = CMSG_FIRSTHDR(&message);
  extra->cmsg_level = SOL_SOCKET;
  extra->cmsg_type = SCM_RIGHTS;
  extra->cmsg_len = CMSG_LEN(sizeof descriptor);
  std::memcpy(CMSG_DATA(extra), &descriptor, sizeof descriptor);
  return sendmsg(socket_.number(), &message, MSG_DONTWAIT | MSG_NOSIGNAL) == 1;
}

void Watchdog::gate_open(bool open) {
  shared_->gate_open.beats.store(open ? 1 : 0, std::memory_order_relaxed);
}

bool Watchdog::watching(Time now) {
  siginfo_t ended{};
  const int asked = waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT);
  if (asked != 0 || ended.si_pid != 0) return false;
  const std::uint64_t beats = shared_->watchdog.beats.load(std::memory_order_relaxed);
  if (beats != heard_ || heard_at_ == Time::min()) {
    heard_ = beats;
    heard_at_ = now;
  }
  return now - heard_at_ <= kOwnLimit;
}

bool Watchdog::has_priority() const {
  return shared_->priority.beats.load(std::memory_order_relaxed) != 0;
}

void Watchdog::leave() {
  dismiss(kLeave);
}

/// Waits until it has ended, and makes it end when it is not able to.
void Watchdog::see_off() {
  int status = 0;
  for (int k = 0; k < kPartingPatience; ++k) {
    if (waitpid(process_, &status, WNOHANG) != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(process_, SIGKILL);
  waitpid(process_, &status, 0);
}

void Watchdog::dismiss(char word) {
  if (process_ < 0) return;
  (void)!send(socket_.number(), &word, 1, MSG_NOSIGNAL);
  // After a failure it goes on by itself, for as long as its zeros last.
  if (word == kLeave) see_off();
  process_ = -1;
  socket_.close();
}

}  // namespace ironbird::hil_bridge
