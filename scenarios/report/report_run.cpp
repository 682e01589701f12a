#include "scenarios/report/report_run.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/record/topics.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

const std::vector<double> kNothing;

}  // namespace

ReportRun ReportRun::read(std::string label, const std::filesystem::path& log_file,
                          const std::filesystem::path& verdict_file) {
  std::optional<Verdict> verdict;
  if (std::filesystem::exists(verdict_file)) verdict = read_verdict(verdict_file);
  ReportRun run(std::move(label), read_flown(log_file), std::move(verdict));
  const std::string digest = run.about("digest");
  if (run.verdict_ && !digest.empty() && digest != run.verdict_->run.digest) {
    run.verdict_.reset();
    run.strange_verdict_ = true;
  }
  return run;
}

std::vector<std::string> ReportRun::notes() const {
  std::vector<std::string> notes;
  std::optional<double> flown;
  for (const Metric& metric : verdict_ ? verdict_->metrics : std::vector<Metric>()) {
    if (metric.name == kSimulatedTime && std::isfinite(metric.value)) flown = metric.value;
  }
  if (const std::string lost = what_is_lost(log_, flown); !lost.empty()) notes.push_back(lost);
  if (strange_verdict_)
    notes.emplace_back("the verdict.json beside the log is of another run and is not shown");
  return notes;
}

const std::vector<double>& ReportRun::time(std::string_view topic) const {
  const LogTopic* found = log_.topic(topic);
  return found == nullptr ? kNothing : found->time();
}

const std::vector<double>& ReportRun::column(std::string_view topic, std::string_view field) const {
  const LogTopic* found = log_.topic(topic);
  return found == nullptr || !found->has(field) ? kNothing : found->column(field);
}

std::string ReportRun::about(std::string_view key) const {
  const auto record = log_.metadata().find("run");
  if (record == log_.metadata().end()) return "";
  const auto entry = record->second.find(std::string(key));
  return entry == record->second.end() ? "" : entry->second;
}

std::vector<RunEvent> ReportRun::events() const {
  if (verdict_) return verdict_->events;
  std::vector<RunEvent> events;
  const LogTopic* topic = log_.topic(kEventTopic);
  if (topic == nullptr) return events;
  try {
    const std::vector<std::string>& kinds = topic->texts("kind");
    const std::vector<std::string>& texts = topic->texts("text");
    for (std::size_t i = 0; i < std::min({topic->time().size(), kinds.size(), texts.size()}); ++i) {
      events.push_back({topic->time()[i], kinds[i], texts[i]});
    }
  } catch (const std::out_of_range&) {
    events.clear();  // a log of another kind: no events to show
  }
  return events;
}

}  // namespace ironbird::scenarios
