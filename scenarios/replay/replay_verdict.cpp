#include "scenarios/replay/replay_verdict.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <system_error>

#include "scenarios/config/config_error.hpp"
#include "scenarios/config/nearest_name.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> names_of_figures() {
  const RecordedEstimate nothing;
  std::vector<std::string> names;
  for (const Metric& metric : Comparison(nothing, {}).results()) names.push_back(metric.name);
  return names;
}

std::string figure(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

CheckResult check_of(const ReplayBound& bound, const ReplayResult& result) {
  CheckResult check;
  check.name = bound.metric + " at most " + figure(bound.most);
  check.kind = "at_most";
  check.time = kNoTime;
  const auto found = std::find_if(result.metrics.begin(), result.metrics.end(),
                                  [&](const Metric& metric) { return metric.name == bound.metric; });
  if (found == result.metrics.end() || !std::isfinite(found->value)) {
    check.margin = kNoTime;
    check.explanation = "nothing could be compared";
    return check;
  }
  check.unit = found->unit;
  check.margin = bound.most - found->value;
  check.outcome = check.margin >= 0.0 ? Outcome::kPass : Outcome::kFail;
  check.explanation = "came to " + figure(found->value) + " " + found->unit;
  return check;
}

CheckResult check_of_health(const ReplayResult& result) {
  CheckResult check;
  check.name = "the estimator starts, and is not lost at the end";
  check.kind = "health";
  check.margin = check.time = kNoTime;
  check.outcome = result.ready && !result.lost_at_end ? Outcome::kPass : Outcome::kFail;
  check.explanation = !result.ready        ? "it never had an estimate"
                      : result.lost_at_end ? "it says that it is lost"
                                           : "ready after " + figure(*result.ready) + " s";
  return check;
}

/// A figure of which little could be compared says little.
CheckResult check_of_share(const ReplayResult& result) {
  constexpr double kEnough = 0.9;
  CheckResult check;
  check.name = "nine tenths of what was recorded in the window could be compared";
  check.kind = "compared";
  check.time = kNoTime;
  const auto share = std::find_if(result.metrics.begin(), result.metrics.end(),
                                  [](const Metric& metric) { return metric.name == "compared_share"; });
  if (share == result.metrics.end() || !std::isfinite(share->value)) {
    check.margin = kNoTime;
    check.explanation = "nothing was recorded there to compare with";
    return check;
  }
  check.unit = "1";
  check.margin = share->value - kEnough;
  check.outcome = check.margin >= 0.0 ? Outcome::kPass : Outcome::kInconclusive;
  check.explanation = "of attitude, position, height and velocity the least was " + figure(share->value);
  return check;
}

}  // namespace

ReplayBound parse_replay_bound(const std::string& text) {
  const std::size_t equals = text.find('=');
  ReplayBound bound{text.substr(0, equals)};
  const std::vector<std::string> names = names_of_figures();
  if (std::find(names.begin(), names.end(), bound.metric) == names.end()) {
    const std::string nearest = nearest_name(bound.metric, names);
    throw ConfigError("--at-most " + text + ": there is no such figure" +
                      (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  }
  const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
  const auto read = std::from_chars(number.data(), number.data() + number.size(), bound.most);
  if (read.ec != std::errc() || read.ptr != number.data() + number.size() || !std::isfinite(bound.most)) {
    throw ConfigError("--at-most " + text + ": must be NAME=NUMBER, for example " + names.front() + "=0.25");
  }
  return bound;
}

Verdict judge_replay(const ReplayResult& result, const RunIdentity& run,
                     const std::vector<ReplayBound>& bounds) {
  Verdict verdict;
  verdict.run = run;
  verdict.metrics = result.metrics;
  verdict.warnings = result.remarks;
  // A flight in which the estimate was lost is flown again as it was.
  if (result.same) {
    verdict.checks.push_back(*result.same);
  } else {
    verdict.checks.push_back(check_of_health(result));
    verdict.checks.push_back(check_of_share(result));
  }
  for (const ReplayBound& bound : bounds) verdict.checks.push_back(check_of(bound, result));
  RunFlaws flaws;
  if (result.interrupted) flaws.broken_promises.emplace_back("the replay was interrupted");
  conclude(verdict, flaws);
  return verdict;
}

}  // namespace ironbird::scenarios
