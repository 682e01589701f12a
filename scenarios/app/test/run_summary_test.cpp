#include "scenarios/app/run_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scenarios/app/exit_code.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RunResult flown(const std::string& scenario, std::uint64_t seed, double path_error,
                Outcome outcome = Outcome::kPass) {
  Verdict verdict;
  verdict.run.scenario = scenario;
  verdict.run.seed = seed;
  verdict.outcome = outcome;
  verdict.metrics = {{"path_rms_total_m", path_error, "m", "path error"}};
  return {{scenario, seed, "out/" + scenario}, verdict, exit_code(outcome), ""};
}

RunResult broken(const std::string& scenario, std::uint64_t seed) {
  return {{scenario, seed, "out/" + scenario}, std::nullopt, kExitInternal, "odd"};
}

TEST(MedianTest, IsTheMiddleAndOfAnEvenCountTheMeanOfTheTwoInTheMiddle) {
  EXPECT_EQ(median(std::vector<double>{3.0}), 3.0);
  EXPECT_EQ(median(std::vector<double>{1.0, 2.0}), 1.5);
  EXPECT_EQ(median(std::vector<double>{1.0, 2.0, 10.0}), 2.0);
  EXPECT_EQ(median(std::vector<double>{1.0, 2.0, 4.0, 10.0}), 3.0);
}

TEST(RunSummaryTest, KeepsScenariosApart) {
  const std::string text = summary_text({flown("calm", 1, 0.1), flown("windy", 1, 5.0), flown("calm", 2, 0.3),
                                         flown("windy", 2, 7.0, Outcome::kFail)});
  EXPECT_THAT(text, HasSubstr("\ncalm: 2 of 2 runs pass\n"));
  EXPECT_THAT(text, HasSubstr("\nwindy: 1 of 2 runs pass\n"));
  EXPECT_THAT(text, HasSubstr("path_rms_total_m                    0.1        0.2        0.3\n"));
  EXPECT_THAT(text, HasSubstr("path_rms_total_m                      5          6          7\n"));
}

TEST(RunSummaryTest, CountsRunsWithoutAVerdictButNotTheirFigures) {
  const std::string text =
      summary_text({flown("calm", 1, 0.1), broken("calm", 2), flown("calm", 3, 99.0, Outcome::kInvalid)});
  EXPECT_THAT(text, HasSubstr("calm, seed 2: no verdict, exit code 4\n"));
  EXPECT_THAT(text, HasSubstr("\ncalm: 1 of 3 runs pass\n"));
  EXPECT_THAT(text, HasSubstr("path_rms_total_m                    0.1        0.1        0.1\n"));
}

TEST(RunSummaryTest, ShowsNoStatisticsOfSingleRuns) {
  EXPECT_THAT(summary_text({flown("calm", 1, 0.1), flown("windy", 1, 5.0)}), Not(HasSubstr("median")));
}

TEST(RunSummaryTest, TheGravestExitCodeCounts) {
  EXPECT_EQ(exit_code_of({flown("a", 1, 0.0), flown("a", 2, 0.0, Outcome::kFail)}), kExitFail);
  EXPECT_EQ(exit_code_of({flown("a", 1, 0.0, Outcome::kFail), broken("a", 2)}), kExitInternal);
  EXPECT_EQ(exit_code_of({flown("a", 1, 0.0, Outcome::kInvalid), flown("a", 2, 0.0)}), kExitInconclusive);
}

TEST(RunSummaryTest, JsonHasEveryRun) {
  RunResult unfilmed = flown("calm", 1, 0.1);
  unfilmed.error = "video.mp4: disk full";
  const nlohmann::json runs = nlohmann::json::parse(summary_json({unfilmed, broken("calm", 2)}));
  EXPECT_EQ(runs[0].at("verdict"), "pass");
  EXPECT_EQ(runs[0].at("error"), "video.mp4: disk full");
  EXPECT_EQ(runs[1].at("seed"), 2);
  EXPECT_EQ(runs[1].at("error"), "odd");
}

}  // namespace
}  // namespace ironbird::scenarios
