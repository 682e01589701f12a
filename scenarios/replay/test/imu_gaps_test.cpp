#include "scenarios/replay/imu_gaps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "simulator/random/stream.hpp"

namespace ironbird::scenarios {
namespace {

using autopilot::Vector3;
using hil_bridge::Time;
using Samples = std::vector<RecordedImuSample>;
constexpr Time kSampleTime = std::chrono::milliseconds(5);
constexpr double kShakeRate = 0.5;  // rad/s

RecordedImuSample sample_at(std::size_t k, const Vector3& f_B, const Vector3& w_NB_B) {
  return {static_cast<int>(k) * kSampleTime, kSampleTime, f_B, w_NB_B};
}

/// A slow turn, and a frame that shakes at nine tenths of half the sampling rate, now more and now less.
Samples shaking(std::size_t count) {
  simulator::Stream noise(1, "imu_gaps_test/shaking");
  Samples samples;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = 0.005 * static_cast<double>(k);
    const double phase = 0.9 * std::numbers::pi * static_cast<double>(k);
    const double shake = (1.0 + 0.3 * std::sin(0.7 * t)) * std::sin(phase) + 0.01 * noise.normal();
    const double turn = 0.4 * std::sin(0.5 * t);
    samples.push_back(sample_at(k, {3.0 * shake, -2.0 * shake, -9.8 + 5.0 * shake},
                                {turn + kShakeRate * shake, 0.3 * shake, 0.1 - 0.2 * shake}));
  }
  return samples;
}

/// Without some of its samples.
template <class IsLost>
Samples without(const Samples& whole, IsLost&& is_lost) {
  Samples left;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    if (!is_lost(k)) left.push_back(whole[k]);
  }
  return left;
}

/// How far the rates are from those of the whole flight at most, where both are.
double worst_rate(const Samples& samples, const Samples& whole) {
  double worst = 0.0;
  for (const RecordedImuSample& sample : samples) {
    const auto k = static_cast<std::size_t>(sample.stamp / kSampleTime);
    worst = std::max(worst, (sample.w_NB_B - whole.at(k).w_NB_B).norm());
  }
  return worst;
}

TEST(ImuGapsTest, ForetellsTheShakeOfTheFrame) {
  // GIVEN a shaking flight of which single samples, and two in a row, are lost
  const Samples whole = shaking(4000);
  const auto is_lost = [](std::size_t k) { return k > 20 && (k % 13 == 0 || k % 91 == 1); };
  Samples samples = without(whole, is_lost);
  double worst_mean = 0.0;
  for (std::size_t k = 26; k + 1 < whole.size(); k += 13) {
    const Vector3 mean = 0.5 * (whole[k - 1].w_NB_B + whole[k + 1].w_NB_B);
    worst_mean = std::max(worst_mean, (mean - whole[k].w_NB_B).norm());
  }
  ASSERT_GT(worst_mean, 2.0 * kShakeRate) << "their neighbours are the opposite";
  // WHEN they are put in
  const std::size_t lost = whole.size() - samples.size();
  EXPECT_EQ(fill_gaps(samples), lost);
  // THEN they are what was lost, within three or so of its noise
  ASSERT_EQ(samples.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) ASSERT_EQ(samples[k].stamp, whole[k].stamp) << k;
  EXPECT_LT(worst_rate(samples, whole), 0.05);
}

TEST(ImuGapsTest, StaysWithinTheFlightWhereEverySecondSampleIsLost) {
  // GIVEN a flight in which single samples are lost that nothing foretells, after a stretch to learn from
  simulator::Stream noise(1, "imu_gaps_test/second");
  Samples whole = shaking(6000);
  for (RecordedImuSample& sample : whole) sample.w_NB_B.x() += 0.3 * noise.normal();
  double greatest = 0.0;
  for (const RecordedImuSample& sample : whole) greatest = std::max(greatest, sample.w_NB_B.norm());
  for (const std::size_t period : {2U, 3U, 4U, 5U}) {
    Samples samples = without(whole, [&](std::size_t k) { return k > 1000 && k % period == 0; });
    fill_gaps(samples);
    // THEN what is put in is never fed on what was put in
    for (const RecordedImuSample& sample : samples) {
      ASSERT_LE(sample.w_NB_B.norm(), 2.0 * greatest) << "period " << period;
    }
  }
}

TEST(ImuGapsTest, LearnsNoMoreFromACrashThanFromTheFlight) {
  const Samples whole = shaking(4000);
  for (const double rate : {30.0, 1e4, 1e30}) {
    Samples samples = without(whole, [](std::size_t k) { return k > 20 && k < 3900 && k % 13 == 0; });
    samples.back().w_NB_B.setConstant(rate);
    samples[samples.size() - 30].w_NB_B.x() = -rate;
    fill_gaps(samples);
    samples.resize(3800);
    EXPECT_LT(worst_rate(samples, whole), 0.1) << rate;
  }
}

TEST(ImuGapsTest, LosesNothingOfASteadyTurn) {
  // GIVEN a turn in white noise, which cannot be foretold, and of which the mean square tells little
  constexpr double kTurn = 0.05;  // rad/s
  constexpr double kNoise = 0.1;  // rad/s
  simulator::Stream noise(1, "imu_gaps_test/turn");
  Samples whole;
  for (std::size_t k = 0; k < 8000; ++k) {
    whole.push_back(sample_at(k, {0.0, 0.0, -9.8}, {kTurn + kNoise * noise.normal(), 0.0, 0.0}));
  }
  Samples samples = without(whole, [](std::size_t k) { return k % 10 == 5; });
  fill_gaps(samples);
  // THEN what is put in turns as far in the mean
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 5; k < whole.size(); k += 10) {
    sum += samples[k].w_NB_B.x();
    ++count;
    EXPECT_NEAR(samples[k].f_B.z(), -9.8, 1e-6);
  }
  constexpr double kKnown = 8.0;  // samples of which each is about the mean
  EXPECT_NEAR(sum / count, kTurn, 5.0 * kNoise / std::sqrt(kKnown * count));
}

TEST(ImuGapsTest, DrawsStraightLinesWhereThereIsLittleToLearnFrom) {
  Samples samples{sample_at(0, Vector3::Zero(), Vector3::Zero()),
                  sample_at(3, {0.0, 3.0, 0.0}, {0.3, 0.0, 0.0})};
  EXPECT_EQ(fill_gaps(samples), 2U);
  ASSERT_EQ(samples.size(), 4U);
  EXPECT_EQ(samples[1].stamp, kSampleTime);
  EXPECT_NEAR(samples[1].f_B.y(), 1.0, 1e-12);
  EXPECT_NEAR(samples[2].w_NB_B.x(), 0.2, 1e-12);
}

TEST(ImuGapsTest, AsksFewerSamplesWhereFourInARowAreRare) {
  // GIVEN a flight in which hardly more than five samples follow each other
  const Samples whole = shaking(6000);
  Samples samples = without(whole, [](std::size_t k) { return k % 6 == 0; });
  fill_gaps(samples);
  samples.erase(samples.begin());
  // THEN two on a side still tell more than their mean
  EXPECT_LT(worst_rate(samples, whole), kShakeRate);
}

TEST(ImuGapsTest, LeavesLongGapsAndThoseBesideNoNumbers) {
  Samples samples = without(shaking(1000), [](std::size_t k) { return (k >= 300 && k < 306) || k == 600; });
  samples[593].f_B.x() = std::numeric_limits<double>::quiet_NaN();  // sample 599
  const std::size_t before = samples.size();
  EXPECT_EQ(fill_gaps(samples), 0U);
  EXPECT_EQ(samples.size(), before);
}

TEST(ImuGapsTest, LearnsNothingFromSamplesThatAreNoNumbers) {
  const Samples whole = shaking(3000);
  Samples samples = without(whole, [](std::size_t k) { return k == 1501; });
  for (std::size_t k = 100; k < 1400; k += 50) {
    samples[k].w_NB_B.z() = std::numeric_limits<double>::infinity();
  }
  ASSERT_EQ(fill_gaps(samples), 1U);
  EXPECT_LT((samples[1501].w_NB_B - whole[1501].w_NB_B).norm(), 0.05);
}

TEST(ImuGapsTest, PutsNothingInWhereNoLengthIsTold) {
  Samples none;
  EXPECT_EQ(fill_gaps(none), 0U);
  Samples samples = without(shaking(1000), [](std::size_t k) { return k == 500; });
  for (RecordedImuSample& sample : samples) sample.length = Time::zero();
  EXPECT_EQ(fill_gaps(samples), 0U);
}

}  // namespace
}  // namespace ironbird::scenarios
