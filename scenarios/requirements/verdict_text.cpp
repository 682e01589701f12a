#include "scenarios/requirements/verdict_text.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

std::string painted(std::string text, Outcome outcome, bool colour) {
  if (!colour) return text;
  const char* code = outcome == Outcome::kPass ? "32" : outcome == Outcome::kFail ? "31" : "33";
  return "\x1b[1;" + std::string(code) + "m" + text + "\x1b[0m";
}

/// Width on a terminal: bytes that continue a UTF-8 character take no room.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(std::string text, std::size_t width) {
  const std::size_t own = width_of(text);
  if (own < width) text.append(width - own, ' ');
  return text;
}

std::string margin_text(const CheckResult& check) {
  if (std::isnan(check.margin)) return "-";
  return (check.margin >= 0.0 ? "+" : "") + with_unit(check.margin, check.unit);
}

std::string time_text(const CheckResult& check) {
  return std::isnan(check.time) ? "-" : with_unit(check.time, "s");
}

std::string headline(const Verdict& verdict) {
  std::string line = verdict.run.scenario;
  if (!verdict.run.title.empty()) line += (line.empty() ? "" : ": ") + verdict.run.title;
  return line + " (seed " + std::to_string(verdict.run.seed) + ")";
}

}  // namespace

std::string verdict_table(const Verdict& verdict, bool colour) {
  constexpr std::size_t kOutcomeWidth = 14;
  std::size_t name_width = 5, margin_width = 6, time_width = 4;
  for (const CheckResult& check : verdict.checks) {
    name_width = std::max(name_width, width_of(check.name));
    margin_width = std::max(margin_width, width_of(margin_text(check)));
    time_width = std::max(time_width, width_of(time_text(check)));
  }
  std::string out = headline(verdict) + "\n";
  if (!verdict.checks.empty()) {
    out += "  " + padded("verdict", kOutcomeWidth) + padded("check", name_width + 2) +
           padded("margin", margin_width + 2) + padded("at", time_width + 2) + "what was found\n";
  }
  for (const CheckResult& check : verdict.checks) {
    const std::string word = padded(std::string(name_of(check.outcome)), kOutcomeWidth);
    out += "  " + painted(word, check.outcome, colour) + padded(check.name, name_width + 2) +
           padded(margin_text(check), margin_width + 2) + padded(time_text(check), time_width + 2) +
           check.explanation + "\n";
  }
  const auto held = std::count_if(verdict.checks.begin(), verdict.checks.end(),
                                  [](const CheckResult& check) { return check.outcome == Outcome::kPass; });
  out += painted(std::string(name_of(verdict.outcome)), verdict.outcome, colour) + ": " +
         std::to_string(held) + " of " + std::to_string(verdict.checks.size()) + " checks hold\n";
  const bool reasons_are_news = verdict.outcome == Outcome::kInvalid || verdict.checks.empty();
  for (const std::string& reason : verdict.reasons) {
    if (reasons_are_news) out += "  " + reason + "\n";
  }
  return out;
}

std::string verdict_lines(const Verdict& verdict) {
  std::string out;
  for (const CheckResult& check : verdict.checks) {
    out += verdict.run.scenario + ": " + std::string(name_of(check.outcome)) + ": " + check.name +
           ": margin " + margin_text(check) + ": " + check.explanation + "\n";
  }
  out += verdict.run.scenario + ": " + std::string(name_of(verdict.outcome));
  for (const std::string& reason : verdict.reasons) {
    if (verdict.outcome == Outcome::kInvalid || verdict.checks.empty()) out += ": " + reason;
  }
  return out + "\n";
}

}  // namespace ironbird::scenarios
