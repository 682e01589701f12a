#include "scenarios/requirements/stl.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simulator/random/stream.hpp"

namespace ironbird::scenarios::stl {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEdge = 1e-9;  // s: the round-off that intervals allow

struct Samples {
  std::vector<double> time;
  std::vector<double> p;
};

/// Random margins at a steady rate that does not divide the intervals evenly.
Samples random_samples(std::uint64_t seed) {
  simulator::Stream stream(seed, "stl/test");
  Samples out;
  const int count = 1 + static_cast<int>(stream.uniform() * 120.0);
  for (int i = 0; i < count; ++i) {
    out.time.push_back(3.0 + i * 0.07);
    out.p.push_back(stream.normal());
  }
  return out;
}

Interval random_interval(std::uint64_t seed) {
  simulator::Stream stream(seed, "stl/interval");
  const double from = stream.uniform() * 4.0;
  return {from, stream.uniform() < 0.3 ? kInfinity : from + stream.uniform() * 4.0};
}

bool inside(double elapsed, Interval interval) {
  return elapsed >= interval.from - kEdge && elapsed <= interval.to + kEdge;
}

class RandomSignalTest : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomSignalTest, AlwaysIsTheLeastMarginOfTheInterval) {
  const Samples s = random_samples(GetParam());
  const Interval interval = random_interval(GetParam());
  Always always(interval);
  double expected = kInfinity;
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    always.sample(s.time[i], s.p[i]);
    if (inside(s.time[i] - s.time[0], interval)) expected = std::min(expected, s.p[i]);
  }
  ASSERT_EQ(always.robustness().has_value(), expected < kInfinity);
  if (always.robustness()) {
    EXPECT_EQ(always.robustness()->margin, expected);
  }
}

TEST_P(RandomSignalTest, EventuallyIsTheDualOfAlways) {
  const Samples s = random_samples(GetParam());
  const Interval interval = random_interval(GetParam());
  Always never(interval);
  Eventually eventually(interval);
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    never.sample(s.time[i], negation(s.p[i]));
    eventually.sample(s.time[i], s.p[i]);
  }
  ASSERT_EQ(eventually.robustness().has_value(), never.robustness().has_value());
  if (!eventually.robustness()) return;
  EXPECT_EQ(eventually.robustness()->margin, -never.robustness()->margin);
  EXPECT_EQ(eventually.robustness()->time, never.robustness()->time);
}

TEST_P(RandomSignalTest, RecentlyIsTheGreatestMarginOfTheSpan) {
  const Samples s = random_samples(GetParam());
  const double span = random_interval(GetParam()).from;
  Recently recently(span, 0.07);
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    double expected = -kInfinity;
    for (std::size_t j = 0; j <= i; ++j) {
      if (s.time[j] >= s.time[i] - span - kEdge) expected = std::max(expected, s.p[j]);
    }
    EXPECT_EQ(recently.sample(s.time[i], s.p[i]), expected) << i;
    EXPECT_EQ(recently.full(), s.time[i] - s.time[0] >= span - kEdge);
  }
}

TEST_P(RandomSignalTest, AlwaysRecentlyMeansNoLongViolation) {
  const Samples s = random_samples(GetParam());
  const double span = 0.2;
  Recently recently(span, 0.07);
  Always always;
  bool long_violation = false;
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    const double margin = recently.sample(s.time[i], s.p[i]);
    if (recently.full()) always.sample(s.time[i], margin);
    bool all_violated = s.time[i] - s.time[0] >= span;
    for (std::size_t j = 0; j <= i; ++j) {
      if (s.time[j] >= s.time[i] - span && s.p[j] >= 0.0) all_violated = false;
    }
    long_violation = long_violation || all_violated;
  }
  if (always.robustness()) {
    EXPECT_EQ(always.robustness()->margin < 0.0, long_violation);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSignalTest, ::testing::Range<std::uint64_t>(1, 101));

TEST(AlwaysTest, TellsTheFirstTimeOfTheLeastMargin) {
  Always always;
  for (const auto& [time, margin] : {std::pair{0.0, 2.0}, {1.0, -1.0}, {2.0, -1.0}, {3.0, 4.0}}) {
    always.sample(time, margin);
  }
  EXPECT_EQ(always.robustness()->time, 1.0);
}

TEST(AlwaysTest, CountsBothEndsOfItsInterval) {
  Always always({1.0, 2.0});
  for (int i = 0; i <= 30; ++i)
    always.sample(5.0 + i * 0.1, i == 10 ? -1.0 : i == 20 ? -2.0 : i == 21 ? -9.0 : 1.0);
  EXPECT_EQ(always.robustness()->margin, -2.0);
}

TEST(RecentlyTest, RefusesAWindowItCannotHold) {
  EXPECT_THROW(Recently(-1.0, 0.1), std::invalid_argument);
  EXPECT_THROW(Recently(1.0, 0.0), std::invalid_argument);
  EXPECT_THROW(Recently(1e9, 1e-3), std::invalid_argument);
}

}  // namespace
}  // namespace ironbird::scenarios::stl
