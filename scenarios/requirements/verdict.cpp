#include "scenarios/requirements/verdict.hpp"

#include <algorithm>

namespace ironbird::scenarios {

namespace {

std::string reason_of(const CheckResult& check) {
  return check.name + ": " + check.explanation;
}

}  // namespace

void conclude(Verdict& verdict, const RunFlaws& flaws) {
  verdict.reasons = flaws.broken_promises;
  if (!flaws.broken_promises.empty()) {
    verdict.outcome = Outcome::kInvalid;
    return;
  }
  verdict.reasons = flaws.gaps;
  const auto not_judged = [](const CheckResult& check) { return check.outcome == Outcome::kNotJudged; };
  if (verdict.checks.empty()) {
    verdict.reasons.emplace_back("the scenario has no checks");
  } else if (std::all_of(verdict.checks.begin(), verdict.checks.end(), not_judged)) {
    verdict.reasons.push_back("none of its checks can be judged: " + verdict.checks.front().explanation);
  }
  verdict.outcome = verdict.reasons.empty() ? Outcome::kPass : Outcome::kInconclusive;
  for (const CheckResult& check : verdict.checks) {
    if (check.outcome == Outcome::kPass || not_judged(check)) continue;
    verdict.reasons.push_back(reason_of(check));
    if (verdict.outcome != Outcome::kFail) verdict.outcome = check.outcome;
  }
}

std::vector<std::string> reasons_of_the_run(const Verdict& verdict) {
  std::vector<std::string> own;
  for (const std::string& reason : verdict.reasons) {
    const bool is_of_a_check =
        std::any_of(verdict.checks.begin(), verdict.checks.end(),
                    [&](const CheckResult& check) { return reason == reason_of(check); });
    if (!is_of_a_check) own.push_back(reason);
  }
  return own;
}

int exit_code(Outcome outcome) {
  constexpr int kAllHold = 0;
  constexpr int kCheckFailed = 1;
  constexpr int kNothingShown = 5;
  if (outcome == Outcome::kPass) return kAllHold;
  return outcome == Outcome::kFail ? kCheckFailed : kNothingShown;
}

}  // namespace ironbird::scenarios
