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

bool has_run_error(const Verdict& verdict) {
  return verdict.outcome == Outcome::kInvalid || verdict.checks.empty();
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

std::string suite_of(const Verdict& verdict) {
  const std::size_t extra = has_run_error(verdict) ? 1 : 0;
  std::string out = "  <testsuite" + attribute("name", verdict.run.scenario) +
                    attribute("tests", std::to_string(verdict.checks.size() + extra)) +
                    attribute("failures", std::to_string(count_of(verdict, Outcome::kFail))) +
                    attribute("errors", std::to_string(count_of(verdict, Outcome::kInconclusive) + extra)) +
                    attribute("time", simulated(verdict)) + ">\n";
  for (const CheckResult& check : verdict.checks) {
    const char* problem = check.outcome == Outcome::kPass   ? ""
                          : check.outcome == Outcome::kFail ? "failure"
                                                            : "error";
    out += test_case(check.name, verdict.run.scenario, problem, check.explanation);
  }
  if (has_run_error(verdict)) {
    std::string reasons;
    for (const std::string& reason : verdict.reasons) reasons += (reasons.empty() ? "" : "; ") + reason;
    out += test_case("the run", verdict.run.scenario, "error", reasons);
  }
  return out + "  </testsuite>\n";
}

/// The property and message escapes of a workflow command.
std::string command_escaped(const std::string& text, bool property) {
  std::string out;
  for (const char letter : text) {
    if (letter == '%') {
      out += "%25";
    } else if (letter == '\n') {
      out += "%0A";
    } else if (property && letter == ':') {
      out += "%3A";
    } else if (property && letter == ',') {
      out += "%2C";
    } else {
      out += letter;
    }
  }
  return out;
}

}  // namespace

std::string junit_xml(const std::vector<Verdict>& verdicts) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const Verdict& verdict : verdicts) out += suite_of(verdict);
  return out + "</testsuites>\n";
}

std::string annotations(const std::vector<Verdict>& verdicts, const std::vector<std::string>& files) {
  std::string out;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const std::string file = i < files.size() ? files[i] : verdicts[i].run.scenario;
    for (const CheckResult& check : verdicts[i].checks) {
      if (check.outcome == Outcome::kPass) continue;
      out += std::string(check.outcome == Outcome::kFail ? "::error" : "::warning") +
             " file=" + command_escaped(file, true) + ",title=" + command_escaped(check.name, true) +
             "::" + command_escaped(check.explanation, false) + "\n";
    }
    if (!has_run_error(verdicts[i])) continue;
    for (const std::string& reason : verdicts[i].reasons) {
      out += "::error file=" + command_escaped(file, true) + "::" + command_escaped(reason, false) + "\n";
    }
  }
  return out;
}

}  // namespace ironbird::scenarios
