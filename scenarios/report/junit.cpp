#include "scenarios/report/junit.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/report/plot/svg.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

using plot::attribute;
using plot::escaped;

std::size_t count_of(const Verdict& verdict, Outcome outcome) {
  return static_cast<std::size_t>(
      std::count_if(verdict.checks.begin(), verdict.checks.end(),
                    [=](const CheckResult& check) { return check.outcome == outcome; }));
}

std::string test_case(const std::string& name, const std::string& suite, const std::string& problem,
                      const std::string& explanation) {
  std::string out = "    <testcase" + attribute("name", name) + attribute("classname", suite);
  if (problem.empty()) return out + "/>\n";
  return out + ">\n      <" + problem + attribute("message", explanation) + "/>\n    </testcase>\n";
}

double simulated(const Verdict& verdict) {
  for (const Metric& metric : verdict.metrics) {
    if (metric.name == "simulated_s" && std::isfinite(metric.value)) return metric.value;
  }
  return 0.0;
}

/// What is wrong with the run as a whole rather than with one of its checks; empty when nothing is.
std::string run_error(const JunitRun& run) {
  std::string all = run.error;
  if (!run.verdict) return all.empty() ? "there is no verdict" : all;
  for (const std::string& reason : reasons_of_the_run(*run.verdict))
    all += (all.empty() ? "" : "; ") + reason;
  return all.empty() && run.verdict->checks.empty() ? "nothing was checked" : all;
}

std::string suite_of(const JunitRun& run) {
  const Verdict verdict = run.verdict.value_or(Verdict{});
  const std::string wrong = run_error(run);
  const std::size_t extra = wrong.empty() ? 0 : 1;
  const std::size_t skipped = count_of(verdict, Outcome::kNotJudged);
  std::string out = "  <testsuite" + attribute("name", run.name) +
                    attribute("tests", std::to_string(verdict.checks.size() + extra)) +
                    attribute("failures", std::to_string(count_of(verdict, Outcome::kFail))) +
                    attribute("errors", std::to_string(count_of(verdict, Outcome::kInconclusive) + extra)) +
                    (skipped == 0 ? "" : attribute("skipped", std::to_string(skipped))) +
                    attribute("time", simulated(verdict)) + ">\n";
  for (const CheckResult& check : verdict.checks) {
    const char* problem = check.outcome == Outcome::kPass        ? ""
                          : check.outcome == Outcome::kFail      ? "failure"
                          : check.outcome == Outcome::kNotJudged ? "skipped"
                                                                 : "error";
    out += test_case(check.name, run.name, problem, check.explanation);
  }
  if (!wrong.empty()) out += test_case("the run", run.name, "error", wrong);
  return out + "  </testsuite>\n";
}

}  // namespace

std::string junit_xml(const std::vector<JunitRun>& runs) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const JunitRun& run : runs) out += suite_of(run);
  return out + "</testsuites>\n";
}

}  // namespace ironbird::scenarios
