#include "scenarios/app/live_run.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <thread>

#include "hil_bridge/executive/monotonic_clock.hpp"
#include "hil_bridge/executive/real_time_rights.hpp"
#include "hil_bridge/transport/awake_cores.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/live_watchdog.hpp"
#include "scenarios/bench/expected_end.hpp"
#include "scenarios/bench/live_bench.hpp"
#include "scenarios/bench/live_rules.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/fcu/unit_line.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

using hil_bridge::InterlockState;

namespace {

constexpr std::chrono::milliseconds kShowPeriod{50};
constexpr std::string_view kWord = "fly";

bool at_terminal() {
  return isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0;
}

UnitAddress address_of(const FcuConfig& fcu) {
  UnitAddress address;
  address.baud = fcu.baud;
  if (fcu.line.starts_with(kUdp)) {
    address.udp = fcu.line.substr(kUdp.size());
  } else {
    address.port = fcu.line;
  }
  return address;
}

std::string in_microseconds(hil_bridge::Time time) {
  return std::to_string((time.count() + 500) / 1000) + " us";
}

std::string timing_line(const hil_bridge::LoopTiming& timing) {
  return "from IMU bytes to command p50 " + in_microseconds(timing.response.quantile(0.5)) + ", p99 " +
         in_microseconds(timing.response.quantile(0.99)) + ", at most " +
         in_microseconds(timing.response.greatest()) + "; " + std::to_string(timing.missed) + " of " +
         std::to_string(timing.passes) + " periods missed";
}

/// Runs the control loop in a thread of its own, to its end or the first error.
class ControlThread {
 public:
  ControlThread(LiveBench& bench, LiveWatchdog& watchdog, const hil_bridge::transport::ByteStream& line)
      : bench_(bench), watchdog_(watchdog), line_(line), thread_([this] { run(); }) {}
  ~ControlThread() { bench_.stop(); }
  ControlThread(const ControlThread&) = delete;
  ControlThread& operator=(const ControlThread&) = delete;

  bool done() const { return done_; }
  /// What the machine did not grant, once it is known; then nothing.
  std::string take_note() {
    if (!note_ready_.exchange(false)) return "";
    return note_;
  }
  /// After done: throws what ended it, if anything did.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void run() {
    const hil_bridge::transport::AwakeCores awake;
    note_ = hil_bridge::take_real_time_rights();
    if (!note_.empty() && !awake.missing().empty()) note_ += "; ";
    note_ += awake.missing();
    note_ready_ = true;
    try {
      while (!bench_.ended()) {
        watchdog_.before_pass(bench_, line_);
        bench_.pass();
      }
    } catch (...) {
      error_ = std::current_exception();
    }
    bench_.close_gate();
    watchdog_.loop_ends();
    hil_bridge::unlock_memory();
    done_ = true;
  }

  LiveBench& bench_;
  LiveWatchdog& watchdog_;
  const hil_bridge::transport::ByteStream& line_;
  std::string note_;
  std::exception_ptr error_;
  std::atomic<bool> note_ready_ = false;
  std::atomic<bool> done_ = false;
  std::jthread thread_;
};

/// Shows the operator how it stands, and hears their word.
class Console {
 public:
  Console(const RunJob& job, RunListener& listener)
      : job_(job), listener_(listener), expected_end_(expected_end(*job.loaded)) {}

  void look(LiveBench& bench) {
    const LiveView& view = bench.view();
    if (view.state != state_) tell(view);
    const double end = shown_end(expected_end_, view.flown, job_.loaded->scenario.duration);
    listener_.progress({job_.name.text(), view.flown, end, detail(view)});
    if (!job_.live.released && at_terminal() && word_typed() && view.state == InterlockState::kVerified) {
      bench.release();
    }
  }

 private:
  void tell(const LiveView& view) {
    state_ = view.state;
    listener_.note(job_.name.text() + ": interlock " + detail(view) + " at " + with_unit(view.time, "s"));
    if (state_ != InterlockState::kVerified || job_.live.released || told_) return;
    told_ = true;
    const FcuConfig& fcu = job_.loaded->scenario.fcu;
    const bool bench = job_.loaded->scenario.interlock.profile == hil_bridge::InterlockProfile::kBench;
    listener_.note(
        "The unit at " + fcu.line +
        " is the one that the scenario wants: parameters, sensors, radio, disarmed.\nOnce released, "
        "it flies the scenario as soon as the pilot arms and hands over; a kill " +
        (bench ? "sends zero thrust." : "falls silent, and the pilot's radio has it.") +
        "\nNobody within ten metres, thumb on the override switch? Type " + std::string(kWord) +
        " and press Enter; Ctrl-C ends.");
  }

  static std::string detail(const LiveView& view) {
    std::string text(name_of(view.state));
    if (view.state == InterlockState::kCold || view.state == InterlockState::kConnected) {
      const std::string missing = what_is_missing(view.inputs);
      if (!missing.empty()) text += " (" + missing + ")";
    } else if (view.state == InterlockState::kReleased) {
      text += " (waits for the pilot to arm)";
    } else if (view.waits_for_pilot) {
      text += " (waits for the pilot to hand over)";
    }
    return text + ", height " + with_unit(view.height, "m");
  }

  /// Has the word been typed? Looks at what is there, and waits for nothing.
  bool word_typed() {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    bool typed = false;
    while (poll(&input, 1, 0) > 0 && (input.revents & POLLIN) != 0) {
      std::array<char, 64> bytes{};
      const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
      if (count <= 0) return typed;
      for (const char byte : std::string_view(bytes.data(), static_cast<std::size_t>(count))) {
        if (byte != '\n') {
          line_ += byte;
          continue;
        }
        typed = typed || line_ == kWord;
        line_.clear();
      }
    }
    return typed;
  }

  const RunJob& job_;
  RunListener& listener_;
  double expected_end_;  // s, of the scenario's own time
  InterlockState state_ = InterlockState::kCold;
  std::string line_;
  bool told_ = false;
};

}  // namespace

Verdict fly_live(const RunJob& job, const autopilot::Modules& modules, RunListener& listener,
                 bool& interrupted) {
  for (const std::string& note : live_notes(job.loaded->scenario)) {
    listener.note(job.name.text() + ": " + note);
  }
  LiveWatchdog watchdog(job.loaded->scenario);  // before the first thread
  if (const std::string note = watchdog.note(); !note.empty()) listener.note(job.name.text() + ": " + note);
  const auto line = open_line(address_of(job.loaded->scenario.fcu));
  LiveOptions options;
  if (job.products.log) options.log_file = job.name.folder / "flight.mcap";
  options.released = job.live.released;
  options.meeting_patience = job.live.meeting_patience;
  options.verified_patience = at_terminal() ? 0.0 : job.live.verified_patience;
  hil_bridge::MonotonicClock clock;
  LiveBench bench(*job.loaded, modules, options, *line, clock);
  ControlThread control(bench, watchdog, *line);
  Console console(job, listener);
  while (!control.done()) {
    watchdog.operator_lives();
    if (interrupt_requested()) bench.stop();
    if (const std::string note = control.take_note(); !note.empty())
      listener.note(job.name.text() + ": " + note);
    console.look(bench);
    std::this_thread::sleep_for(kShowPeriod);
  }
  control.rethrow();
  watchdog.leave();
  interrupted = interrupt_requested();
  listener.note(job.name.text() + ": " + timing_line(bench.timing()));
  return bench.finish(std::chrono::duration<double>(clock.now()).count());
}

void check_live_jobs(const std::vector<RunJob>& jobs) {
  for (const RunJob& job : jobs) {
    if (job.loaded->scenario.fcu.kind != FcuKind::kSerial) continue;
    if (jobs.size() > 1) {
      throw ConfigError(
          "fcu.kind = \"serial\": a real vehicle flies one run at a time; name one scenario and at "
          "most one seed");
    }
    if (job.products.video || job.products.snapshots) {
      throw ConfigError(
          "fcu.kind = \"serial\": film and snapshots show the truth of a simulation; leave --video "
          "and --snapshots away");
    }
    if (!job.live.released && !at_terminal()) {
      throw ConfigError(
          "fcu.kind = \"serial\" commands a real vehicle: say --release once it is safe, or run it "
          "on a terminal, where it asks");
    }
  }
}

}  // namespace ironbird::scenarios
