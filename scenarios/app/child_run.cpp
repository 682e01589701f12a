#include "scenarios/app/child_run.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/failure.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

using Json = nlohmann::json;

constexpr std::chrono::milliseconds kTellPeriod{100};

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Tells the parent: one JSON object a line.
class PipeListener final : public RunListener {
 public:
  explicit PipeListener(int pipe) : pipe_(pipe) {}

  void progress(const WorkDone& work) override {
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < kTellPeriod || !(work.total > 0.0)) return;
    told_ = now;
    // Pictures come after the flight; the bar of many runs counts flights.
    if (work.label != "film") send({{"share", work.done / work.total}});
  }
  void judged(const Verdict&) override {}  // comes with the result
  void note(const std::string& line) override { send({{"note", line}}); }

  void ended(const RunResult& result) const {
    Json json = {{"exit_code", result.exit_code}, {"error", result.error}};
    if (result.verdict) json["verdict"] = to_json(*result.verdict);
    send({{"result", std::move(json)}});
  }

 private:
  void send(const Json& json) const {
    const std::string line = dumped(json) + "\n";
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t count = ::write(pipe_, line.data() + sent, line.size() - sent);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return;  // nobody listens any more
      sent += static_cast<std::size_t>(count);
    }
  }

  int pipe_;
  std::chrono::steady_clock::time_point told_{};
};

[[noreturn]] void work(const RunJob& job, const autopilot::Modules& modules, int pipe, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(kExitInterrupted);  // it ended before we asked to follow it
  PipeListener listener(pipe);
  const RunResult result = run_job(job, modules, listener);
  listener.ended(result);
  std::fflush(nullptr);
  _exit(result.exit_code);
}

}  // namespace

ChildRun::ChildRun(const RunJob& job, const autopilot::Modules& modules) : name_(job.name) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw UserError(std::string("cannot start another run: no pipe: ") + std::strerror(errno));
  }
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[0]);
    work(job, modules, ends[1], parent);
  }
  const int reason = errno;
  ::close(ends[1]);
  pipe_ = ends[0];
  if (process_ > 0) return;
  ::close(pipe_);
  throw UserError(std::string("cannot start another run: ") + std::strerror(reason));
}

ChildRun::~ChildRun() {
  if (process_ > 0) {
    kill();
    ::waitpid(process_, nullptr, 0);
  }
  if (pipe_ >= 0) ::close(pipe_);
}

ChildRun::ChildRun(ChildRun&& other) noexcept
    : name_(std::move(other.name_)),
      process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      unread_(std::move(other.unread_)),
      share_(other.share_),
      notes_(std::move(other.notes_)),
      told_(std::move(other.told_)) {}

ChildRun& ChildRun::operator=(ChildRun&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(process_, other.process_);
  std::swap(pipe_, other.pipe_);
  std::swap(unread_, other.unread_);
  std::swap(share_, other.share_);
  std::swap(notes_, other.notes_);
  std::swap(told_, other.told_);
  return *this;
}

bool ChildRun::listen() {
  std::array<char, 4096> buffer{};
  const ssize_t count = ::read(pipe_, buffer.data(), buffer.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  unread_.append(buffer.data(), static_cast<std::size_t>(count));
  for (std::size_t end = 0; (end = unread_.find('\n')) != std::string::npos; unread_.erase(0, end + 1)) {
    hear(unread_.substr(0, end));
  }
  return count > 0;
}

void ChildRun::hear(const std::string& line) {
  try {
    const Json json = Json::parse(line);
    if (json.contains("share")) share_ = json.at("share");
    if (json.contains("note")) notes_.push_back(json.at("note"));
    if (!json.contains("result")) return;
    const Json& result = json.at("result");
    told_ = RunResult{name_, std::nullopt, result.at("exit_code"), result.at("error")};
    if (result.contains("verdict")) told_->verdict = verdict_from_json(result.at("verdict"));
  } catch (const std::exception& error) {
    told_ = RunResult{name_, std::nullopt, kExitInternal,
                      failure_of(std::runtime_error(std::string("what the run told: ") + error.what())).text};
  }
}

std::vector<std::string> ChildRun::take_notes() {
  return std::exchange(notes_, {});
}

void ChildRun::interrupt() const {
  ::kill(process_, SIGTERM);
}

void ChildRun::kill() const {
  ::kill(process_, SIGKILL);
}

RunResult ChildRun::result() {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
  if (told_) return *told_;
  RunResult result{name_, std::nullopt, kExitInternal, {}};
  const Failure failure =
      WIFSIGNALED(status)
          ? failure_of_signal(WTERMSIG(status))
          : failure_of(std::runtime_error("ended with exit code " + std::to_string(WEXITSTATUS(status)) +
                                          " before its verdict"));
  result.exit_code = failure.exit_code;
  result.error = failure.text;
  return result;
}

}  // namespace ironbird::scenarios
