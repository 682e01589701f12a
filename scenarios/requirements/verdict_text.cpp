#include "scenarios/requirements/verdict_text.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
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
  return (check.margin >= 0.0 ? "+" : "") + with_unit(check.margin, check.unit, check.angles);
}

std::string time_text(const CheckResult& check) {
  return std::isnan(check.time) ? "-" : with_unit(check.time, "s");
}

std::string headline(const Verdict& verdict) {
  std::string line = verdict.run.scenario;
  if (!verdict.run.title.empty()) line += (line.empty() ? "" : ": ") + verdict.run.title;
  return line + " (seed " + std::to_string(verdict.run.seed) + ")";
}

constexpr std::size_t kOutcomeWidth = 14;
/// With less room than this behind the other columns, the explanation gets lines of its own.
constexpr std::size_t kNarrowestExplanation = 24;

/// Breaks the text between words where a line of `columns` would end; what follows begins `indent` further
/// in.
/// @param columns  0: one line
std::string wrapped(const std::string& text, std::size_t indent, std::size_t columns) {
  if (columns <= indent) return text;
  std::istringstream words(text);
  std::string out;
  std::size_t used = indent;
  for (std::string word; words >> word;) {
    const std::size_t width = width_of(word);
    if (!out.empty() && used + 1 + width > columns) {
      out += "\n" + std::string(indent, ' ');
      used = indent;
    } else if (!out.empty()) {
      out += " ";
      ++used;
    }
    out += word;
    used += width;
  }
  return out;
}

/// Widths of the columns of the table, with the gaps behind them.
struct Widths {
  std::size_t name = 7;
  std::size_t margin = 8;
  std::size_t time = 6;

  std::size_t before_explanation() const { return 2 + kOutcomeWidth + name + margin + time; }
};

Widths widths_of(const Verdict& verdict) {
  Widths widths;
  for (const CheckResult& check : verdict.checks) {
    widths.name = std::max(widths.name, width_of(check.name) + 2);
    widths.margin = std::max(widths.margin, width_of(margin_text(check)) + 2);
    widths.time = std::max(widths.time, width_of(time_text(check)) + 2);
  }
  return widths;
}

std::string head_row(const Widths& widths) {
  return "  " + padded("verdict", kOutcomeWidth) + padded("check", widths.name) +
         padded("margin", widths.margin) + padded("at", widths.time) + "what was found\n";
}

std::string row(const CheckResult& check, const Widths& widths, bool colour, std::size_t columns) {
  const std::string word = padded(std::string(name_of(check.outcome)), kOutcomeWidth);
  return "  " + painted(word, check.outcome, colour) + padded(check.name, widths.name) +
         padded(margin_text(check), widths.margin) + padded(time_text(check), widths.time) +
         wrapped(check.explanation, widths.before_explanation(), columns) + "\n";
}

/// The same on a narrow terminal, line by line.
std::string stacked_row(const CheckResult& check, bool colour, std::size_t columns) {
  constexpr std::size_t kIndent = 4;
  const std::string indent(kIndent, ' ');
  const std::string word(name_of(check.outcome));
  const std::string at = std::isnan(check.time) ? "" : " at " + time_text(check);
  return "  " + painted(word, check.outcome, colour) + " " +
         wrapped(check.name, kIndent + word.size(), columns) + "\n" + indent + "margin " +
         margin_text(check) + at + "\n" + indent + wrapped(check.explanation, kIndent, columns) + "\n";
}

}  // namespace

std::string verdict_table(const Verdict& verdict, bool colour, std::size_t columns) {
  std::string out = wrapped(headline(verdict), 2, columns) + "\n";
  if (!verdict.checks.empty()) {
    const Widths widths = widths_of(verdict);
    const bool stacked = columns > 0 && columns < widths.before_explanation() + kNarrowestExplanation;
    if (!stacked) out += head_row(widths);
    for (const CheckResult& check : verdict.checks) {
      out += stacked ? stacked_row(check, colour, columns) : row(check, widths, colour, columns);
    }
  }
  const auto held = std::count_if(verdict.checks.begin(), verdict.checks.end(),
                                  [](const CheckResult& check) { return check.outcome == Outcome::kPass; });
  const auto open = std::count_if(verdict.checks.begin(), verdict.checks.end(), [](const CheckResult& check) {
    return check.outcome == Outcome::kNotJudged;
  });
  out += painted(std::string(name_of(verdict.outcome)), verdict.outcome, colour) + ": " +
         std::to_string(held) + " of " + std::to_string(verdict.checks.size()) + " checks hold" +
         (open > 0 ? ", " + std::to_string(open) + " not judged" : "") + "\n";
  for (const std::string& reason : reasons_of_the_run(verdict))
    out += "  " + wrapped(reason, 2, columns) + "\n";
  for (const std::string& warning : verdict.warnings)
    out += wrapped("warning: " + warning, 2, columns) + "\n";
  return out;
}

std::string verdict_lines(const Verdict& verdict) {
  std::string out;
  for (const CheckResult& check : verdict.checks) {
    out += verdict.run.scenario + ": " + std::string(name_of(check.outcome)) + ": " + check.name +
           ": margin " + margin_text(check) + ": " + check.explanation + "\n";
  }
  out += verdict.run.scenario + ": " + std::string(name_of(verdict.outcome));
  std::string reasons;
  for (const std::string& reason : reasons_of_the_run(verdict))
    reasons += (reasons.empty() ? ": " : "; ") + reason;
  out += reasons + "\n";
  for (const std::string& warning : verdict.warnings)
    out += verdict.run.scenario + ": warning: " + warning + "\n";
  return out;
}

}  // namespace ironbird::scenarios
