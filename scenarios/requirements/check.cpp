#include "scenarios/requirements/check.hpp"

#include <limits>
#include <stdexcept>

#include "scenarios/requirements/assertions.hpp"

namespace ironbird::scenarios {

namespace {

/// What a check without a name is called: its kind, and what it is about.
std::string name_of(const std::string& kind, const CheckConfig& config) {
  std::string about = config.signal.empty() ? config.metric : config.signal;
  for (const std::string& signal : config.error) about += (about.empty() ? "" : " - ") + signal;
  if (config.happens) about = *config.happens;
  if (config.never_happens) about = *config.never_happens;
  for (const auto* events : {&config.order_of_events, &config.none_of_events}) {
    for (const std::string& event : *events ? **events : std::vector<std::string>())
      about += (about.empty() ? "" : ", ") + event;
  }
  return kind + " " + about;
}

}  // namespace

Check::Check(const CheckConfig& config, const CheckContext& context) : name_(config.name) {
  if (context.signals == nullptr) throw std::invalid_argument("checks need a table of signals");
  if (!(context.tick > 0.0)) throw std::invalid_argument("checks need a tick > 0 s");
  kind_ = kind_of(config);
  window_ = Window(config.after, config.until);
  assertion_ = make_assertion(kind_, config, context);
  if (name_.empty()) name_ = name_of(kind_, config);
}

CheckResult Check::result(const RunFacts& facts) const {
  CheckResult result;
  result.name = name_;
  result.kind = kind_;
  if (!opened_) {
    result.margin = result.time = std::numeric_limits<double>::quiet_NaN();
    result.explanation = window_.why_empty(ended_);
    return result;
  }
  assertion_->judge(facts, result);
  if (is_about_all_of_its_window(kind_)) object(result, window_.why_open(ended_));
  return result;
}

void object(CheckResult& result, const std::string& reason) {
  if (result.outcome != Outcome::kPass || reason.empty()) return;
  result.outcome = Outcome::kInconclusive;
  result.explanation += "; shows nothing: " + reason;
}

std::string complaint_at(const std::string& path, const std::string& complaint) {
  const std::string first = complaint.substr(0, complaint.find_first_of(" .:=["));
  bool is_key = false;
  const CheckConfig any;
  CheckConfig::describe(any, [&](const char* name, const auto&, const char*, const char*) {
    is_key = is_key || name == first;
  });
  return path + (is_key ? "." : ": ") + complaint;
}

}  // namespace ironbird::scenarios
