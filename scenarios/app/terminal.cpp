#include "scenarios/app/terminal.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace ironbird::scenarios {

namespace {

constexpr std::chrono::milliseconds kRedrawPeriod{100};
constexpr int kBarCells = 24;

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

std::string bar(double share) {
  const int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * kBarCells);
  std::string cells;
  for (int i = 0; i < kBarCells; ++i) cells += i < full ? "█" : "░";
  return cells;
}

}  // namespace

Terminal Terminal::of_standard_error() {
  const char* term = std::getenv("TERM");
  const bool dumb = term == nullptr || std::string_view(term) == "dumb";
  Terminal terminal;
  terminal.interactive = isatty(STDERR_FILENO) != 0 && !dumb && !is_set("CI");
  terminal.colour = isatty(STDERR_FILENO) != 0 && !dumb && !is_set("NO_COLOR");
  return terminal;
}

ProgressBar::ProgressBar(const Terminal& terminal, std::string label)
    : terminal_(terminal),
      label_(std::move(label)),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::show(double done, double total, const std::string& detail) {
  if (!terminal_.interactive) return;
  const auto now = std::chrono::steady_clock::now();
  if (visible_ && now - drawn_ < kRedrawPeriod) return;
  drawn_ = now;
  visible_ = true;
  const double share = total > 0.0 ? done / total : 0.0;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = share > 0.0 ? elapsed * (1.0 - share) / share : 0.0;
  std::fprintf(stderr, "\r\033[K%s %s %3.0f %%  %s  %.0f s left", label_.c_str(), bar(share).c_str(),
               share * 100.0, detail.c_str(), left);
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!visible_) return;
  visible_ = false;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace ironbird::scenarios
