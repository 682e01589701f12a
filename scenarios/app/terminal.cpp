#include "scenarios/app/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "scenarios/requirements/verdict_text.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::chrono::milliseconds kRedrawPeriod{100};
constexpr std::chrono::seconds kPlainPeriod{30};
constexpr int kBarCells = 24;

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

Terminal terminal_behind(int descriptor) {
  const char* term = std::getenv("TERM");
  const bool dumb = term == nullptr || std::string_view(term) == "dumb";
  const bool watched = isatty(descriptor) != 0;
  Terminal terminal;
  terminal.interactive = watched && !dumb && !is_set("CI");
  terminal.colour = watched && !dumb && !is_set("NO_COLOR");
  winsize size{};
  if (watched && ioctl(descriptor, TIOCGWINSZ, &size) == 0) {
    terminal.columns = size.ws_col;
    terminal.rows = size.ws_row;
  }
  return terminal;
}

std::string bar(double share) {
  const int full = static_cast<int>(share * kBarCells);
  std::string cells;
  for (int i = 0; i < kBarCells; ++i) cells += i < full ? "█" : "░";
  return cells;
}

double share_of(const WorkDone& work) {
  return work.total > 0.0 ? std::clamp(work.done / work.total, 0.0, 1.0) : 0.0;
}

}  // namespace

Terminal Terminal::of_standard_error() {
  return terminal_behind(STDERR_FILENO);
}

Terminal Terminal::of_standard_output() {
  return terminal_behind(STDOUT_FILENO);
}

std::string progress_line(const WorkDone& work, double seconds_left, std::size_t columns) {
  char numbers[64];
  std::snprintf(numbers, sizeof numbers, "%3.0f %%", share_of(work) * 100.0);
  char left[64];
  std::snprintf(left, sizeof left, "  %.0f s left", seconds_left);
  const std::string detail = work.detail.empty() ? "" : "  " + work.detail;
  const std::pair<std::string, std::size_t> forms[] = {
      {work.label + " " + bar(share_of(work)) + " " + numbers + detail + left,
       work.label.size() + 2 + kBarCells + std::string_view(numbers).size() + detail.size() +
           std::string_view(left).size()},
      {work.label + " " + numbers + detail + left, 0},
      {work.label + " " + numbers + left, 0},
      {work.label + " " + numbers, 0}};
  for (const auto& [text, width] : forms) {
    if (columns == 0 || (width == 0 ? text.size() : width) <= columns) return text;
  }
  return forms[3].first.substr(forms[3].first.size() - std::min(forms[3].first.size(), columns));
}

ProgressBar::ProgressBar(const Terminal& terminal)
    : terminal_(terminal), start_(std::chrono::steady_clock::now()), drawn_(start_) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::show(const WorkDone& work) {
  const auto now = std::chrono::steady_clock::now();
  if (work.label != label_) {
    label_ = work.label;
    start_ = drawn_ = now;
  } else if (terminal_.interactive ? visible_ && now - drawn_ < kRedrawPeriod : now - drawn_ < kPlainPeriod) {
    return;
  } else {
    drawn_ = now;
  }
  if (terminal_.interactive || drawn_ != start_) draw(work);
}

void ProgressBar::draw(const WorkDone& work) {
  const double share = share_of(work);
  const double elapsed = std::chrono::duration<double>(drawn_ - start_).count();
  const double left = share > 0.0 ? elapsed * (1.0 - share) / share : 0.0;
  if (!terminal_.interactive) {
    std::fprintf(stderr, "%s: %.0f %%, %s, %.0f s left\n", work.label.c_str(), share * 100.0,
                 work.detail.c_str(), left);
    return;
  }
  // A line that fills the last column would already wrap on some terminals.
  const std::size_t room = terminal_.columns > 1 ? terminal_.columns - 1 : terminal_.columns;
  std::fprintf(stderr, "\r\033[K%s", progress_line(work, left, room).c_str());
  std::fflush(stderr);
  visible_ = true;
}

void ProgressBar::clear() {
  if (!visible_) return;
  visible_ = false;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void TerminalListener::judged(const Verdict& verdict) {
  bar_.clear();
  const std::string text = terminal_.interactive ? verdict_table(verdict, terminal_.colour, terminal_.columns)
                                                 : verdict_lines(verdict);
  std::fputs(text.c_str(), stderr);
}

void TerminalListener::note(const std::string& line) {
  bar_.clear();
  std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace ironbird::scenarios
