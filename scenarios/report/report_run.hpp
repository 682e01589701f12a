#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/record/log.hpp"
#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// One run as the report sees it: its log and, where there is one, its verdict.
class ReportRun {
 public:
  ReportRun(std::string label, Log log, std::optional<Verdict> verdict)
      : label_(std::move(label)), log_(std::move(log)), verdict_(std::move(verdict)) {}

  /// Reads a log of which something can be shown and, when the file is there and is of the same run, a
  /// verdict. @throws std::runtime_error naming what cannot be read
  static ReportRun read(std::string label, const std::filesystem::path& log_file,
                        const std::filesystem::path& verdict_file);

  const std::string& label() const { return label_; }
  const Log& log() const { return log_; }
  const std::optional<Verdict>& verdict() const { return verdict_; }

  /// Times of a topic's messages, s; empty when the log has no such topic.
  const std::vector<double>& time(std::string_view topic) const;

  /// A column of a topic; empty when the log has no such topic or field.
  const std::vector<double>& column(std::string_view topic, std::string_view field) const;

  /// An entry of the metadata record "run"; empty when there is none.
  std::string about(std::string_view key) const;

  /// What to know before one believes what is shown, one line each: a log that was cut short, a verdict of
  /// another run beside it.
  std::vector<std::string> notes() const;

  /// What happened: the verdict's events, or those of the log, in order of time.
  std::vector<RunEvent> events() const;

 private:
  std::string label_;
  Log log_;
  std::optional<Verdict> verdict_;
  bool strange_verdict_ = false;  // the one beside the log is of another run
};

}  // namespace ironbird::scenarios
