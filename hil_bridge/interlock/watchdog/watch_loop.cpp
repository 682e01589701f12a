#include "hil_bridge/interlock/watchdog/watch_loop.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hil_bridge/transport/machine_clock.hpp"

namespace ironbird::hil_bridge {

namespace {

using transport::FileDescriptor;
using transport::machine_time;

constexpr Time kLinePeriod = std::chrono::milliseconds(100);
constexpr int kDeathPatience = 20;  // ms; a process told to die runs no more code of its own anyway

int milliseconds(Time time) {
  return static_cast<int>(std::max<std::int64_t>(time.count() / 1'000'000, 1));
}

/// Says a line, unless nobody can take it now: a terminal that is held must not hold the watchdog.
void say(const std::string& text) {
  const std::string line = "watchdog: " + text + "\n";
  pollfd state{STDERR_FILENO, POLLOUT, 0};
  if (poll(&state, 1, 0) <= 0 || (state.revents & POLLOUT) == 0) return;
  (void)!write(STDERR_FILENO, line.data(), line.size());
}

bool is_readable(int descriptor, int patience_ms) {
  pollfd state{descriptor, POLLIN, 0};
  return poll(&state, 1, patience_ms) > 0;
}

}  // namespace

WatchLoop::WatchLoop(SharedBeats& shared, const WatchdogConfig& config, FileDescriptor bench,
                     FileDescriptor socket)
    : shared_(shared), config_(config), bench_(std::move(bench)), socket_(std::move(socket)) {}

void WatchLoop::run() {
  for (std::uint64_t beat = 1;; ++beat) {
    shared_.watchdog.beats.store(beat, std::memory_order_relaxed);
    take_orders();
    if (left_) return;
    if (bench_gone(0)) {
      take_orders();  // it may have taken leave between the two looks
      return left_ ? void() : bite("the bench has ended without taking leave", false);
    }
    // One that fails before anything was released says why itself.
    if (abandoned_ && !gate_open()) return;
    if (abandoned_) return bite("the bench has failed and ends", false);
    const Time now = machine_time();
    if (const auto what = silence(now)) return bite(*what + "; the bench was killed", true);
    drop_dead_line(now);
    pollfd events[] = {{bench_.number(), POLLIN, 0}, {socket_.number(), POLLIN, 0}};
    poll(events, 2, milliseconds(config_.look));
  }
}

void WatchLoop::take_orders() {
  while (socket_) {
    char word = 0;
    iovec part{&word, 1};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> room{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = room.data();
    message.msg_controllen = room.size();
    const ssize_t count = recvmsg(socket_.number(), &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    // The other end is closed: how the bench fares is seen elsewhere.
    if (count <= 0) return socket_.close();
    left_ = left_ || word == kLeave;
    abandoned_ = abandoned_ || word == kAbandon;
    const cmsghdr* const extra = CMSG_FIRSTHDR(&message);
    if (extra != nullptr && extra->cmsg_type == SCM_RIGHTS) {
      int descriptor = -1;
      std::memcpy(&descriptor, CMSG_DATA(extra), sizeof descriptor);
      line_.take_line(FileDescriptor(descriptor));
    }
  }
}

void WatchLoop::drop_dead_line(Time now) {
  if (now - line_seen_ < kLinePeriod) return;
  line_seen_ = now;
  line_.drop_if_dead();
}

bool WatchLoop::gate_open() const {
  return shared_.gate_open.beats.load(std::memory_order_relaxed) != 0;
}

bool WatchLoop::bench_gone(int patience_ms) const {
  return is_readable(bench_.number(), patience_ms);
}

std::optional<std::string> WatchLoop::silence(Time now) {
  for (std::size_t k = 0; k < config_.threads.size(); ++k) {
    const GuardedThread& thread = config_.threads[k];
    const std::uint64_t beats = shared_.threads[k].beats.load(std::memory_order_relaxed);
    Watched& watched = watched_[k];
    if (beats == 0 || beats != watched.beats) {
      watched = {beats, now};
    } else if (now - watched.changed > thread.limit) {
      return thread.name + " was silent for " + std::to_string(milliseconds(now - watched.changed)) +
             " ms, its limit is " + std::to_string(milliseconds(thread.limit)) + " ms";
    }
  }
  return std::nullopt;
}

void WatchLoop::bite(const std::string& why, bool kill) {
  if (kill) {
    syscall(SYS_pidfd_send_signal, bench_.number(), SIGKILL, nullptr, 0);
    bench_gone(kDeathPatience);
  }
  line_.drop_if_dead();
  line_.discard_old();
  if (!gate_open()) {
    say(why + "; the gate was closed, nothing is sent");
  } else if (config_.profile == InterlockProfile::kFlight) {
    say(why + "; nothing more is sent, the pilot's radio has the vehicle within the unit's time-out");
  } else if (!line_.has_line()) {
    say(why + "; no line to the unit is open, nothing can be sent");
  } else {
    finish_with_zeros(why);
  }
}

void WatchLoop::finish_with_zeros(const std::string& what_happened) {
  const Time end = machine_time() + config_.zeros_at_most;
  line_.send_zero();
  say(what_happened + "; sending zero thrust until the unit says that it is disarmed, for at most " +
      std::to_string(milliseconds(config_.zeros_at_most) / 1000) + " s");
  // Not the line is waited for: one that has gone is ready for ever, and at this priority nothing else would
  // have the core.
  for (Time next = machine_time(); next < end;) {
    next = std::max(next + config_.zero_period, machine_time());
    transport::sleep_until(next);
    if (line_.heard_disarmed()) return say("the unit says that it is disarmed");
    line_.drop_if_dead();
    if (!line_.has_line()) return say("the line to the unit is gone: disarm it by radio");
    line_.send_zero();
  }
  say("the unit has not said that it is disarmed: disarm it by radio");
}

bool stand_apart(int bench, int socket) {
  setsid();
  for (int signal_number = 1; signal_number < NSIG; ++signal_number) {
    const bool fault = signal_number == SIGSEGV || signal_number == SIGBUS || signal_number == SIGILL ||
                       signal_number == SIGFPE || signal_number == SIGABRT;
    if (!fault) signal(signal_number, SIG_IGN);
  }
  prctl(PR_SET_NAME, "ironbird-guard");
  const auto [low, high] = std::minmax(bench, socket);
  close_range(STDERR_FILENO + 1, static_cast<unsigned>(low) - 1U, 0);
  if (low + 1 < high) close_range(static_cast<unsigned>(low) + 1U, static_cast<unsigned>(high) - 1U, 0);
  close_range(static_cast<unsigned>(high) + 1U, ~0U, 0);
  const FileDescriptor nothing(open("/dev/null", O_RDWR | O_CLOEXEC));
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO}) dup2(nothing.number(), standard);
  mlockall(MCL_CURRENT | MCL_FUTURE);
  sched_param priority{};
  priority.sched_priority = sched_get_priority_max(SCHED_FIFO);
  return sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
}

}  // namespace ironbird::hil_bridge
