#include "scenarios/requirements/verdict.hpp"

#include <algorithm>

namespace ironbird::scenarios {

void conclude(Verdict& verdict, const std::vector<std::string>& broken_promises) {
  verdict.reasons = broken_promises;
  if (!broken_promises.empty()) {
    verdict.outcome = Outcome::kInvalid;
    return;
  }
  if (verdict.checks.empty()) {
    verdict.outcome = Outcome::kInconclusive;
    verdict.reasons.push_back("the scenario has no checks");
    return;
  }
  const auto not_judged = [](const CheckResult& check) { return check.outcome == Outcome::kNotJudged; };
  if (std::all_of(verdict.checks.begin(), verdict.checks.end(), not_judged)) {
    verdict.outcome = Outcome::kInconclusive;
    verdict.reasons.push_back("none of its checks can be judged: " + verdict.checks.front().explanation);
    return;
  }
  verdict.outcome = Outcome::kPass;
  for (const CheckResult& check : verdict.checks) {
    if (check.outcome == Outcome::kPass || not_judged(check)) continue;
    verdict.reasons.push_back(check.name + ": " + check.explanation);
    if (verdict.outcome != Outcome::kFail) verdict.outcome = check.outcome;
  }
}

int exit_code(Outcome outcome) {
  constexpr int kAllHold = 0;
  constexpr int kCheckFailed = 1;
  constexpr int kNothingShown = 5;
  if (outcome == Outcome::kPass) return kAllHold;
  return outcome == Outcome::kFail ? kCheckFailed : kNothingShown;
}

}  // namespace ironbird::scenarios
