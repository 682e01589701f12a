#include "scenarios/replay/imu_gaps.hpp"

#include <gtest/gtest.h>

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
constexpr Time kSampleTime = std::chrono::milliseconds(5);

ImuSample sample_at(std::size_t k, const Vector3& force, const Vector3& rate) {
  return {static_cast<int>(k) * kSampleTime, kSampleTime, force, rate};
}

/// A slow turn, and a frame that shakes at nine tenths of half the sampling rate, now more and now less.
std::vector<ImuSample> shaking(std::size_t count) {
  std::vector<ImuSample> samples;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = 0.005 * static_cast<double>(k);
    const double shake = (1.0 + 0.3 * std::sin(0.7 * t)) * std::sin(0.9 * std::numbers::pi * k);
    const double turn = 0.4 * std::sin(0.5 * t);
    samples.push_back(sample_at(k, {3.0 * shake, -2.0 * shake, -9.8 + 5.0 * shake},
                                {turn + 0.5 * shake, 0.3 * shake, 0.1 - 0.2 * shake}));
  }
  return samples;
}

/// Without some of its samples.
template <class IsLost>
std::vector<ImuSample> without(const std::vector<ImuSample>& whole, IsLost&& is_lost) {
  std::vector<ImuSample> left;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    if (!is_lost(k)) left.push_back(whole[k]);
  }
  return left;
}

TEST(ImuGapsTest, ForetellsTheShakeOfTheFrame) {
  // GIVEN a shaking flight of which single samples, and two in a row, are lost
  const auto whole = shaking(4000);
  const auto is_lost = [](std::size_t k) { return k > 20 && (k % 13 == 0 || k % 91 == 1); };
  auto samples = without(whole, is_lost);
  // WHEN they are put in
  const std::size_t count = fill_gaps(samples);
  // THEN they are what was lost, where the mean of their neighbours would be the opposite
  ASSERT_EQ(samples.size(), whole.size());
  EXPECT_EQ(count, whole.size() - without(whole, is_lost).size());
  double worst = 0.0;
  double worst_mean = 0.0;
  for (std::size_t k = 21; k + 2 < whole.size(); ++k) {
    ASSERT_EQ(samples[k].when, whole[k].when) << k;
    worst = std::max(
        {worst, (samples[k].rate - whole[k].rate).norm(), 0.1 * (samples[k].force - whole[k].force).norm()});
    worst_mean = std::max(worst_mean, (0.5 * (whole[k - 1].rate + whole[k + 1].rate) - whole[k].rate).norm());
  }
  EXPECT_GT(worst_mean, 1.0) << "rad/s";
  EXPECT_LT(worst, 0.02) << "rad/s, and tenths of m/s^2";
}

TEST(ImuGapsTest, LosesNothingOfASteadyTurn) {
  // GIVEN a steady turn in white noise, which cannot be foretold
  constexpr double kTurn = 2.0;  // rad/s
  simulator::Stream noise(1, "imu_gaps_test");
  std::vector<ImuSample> whole;
  for (std::size_t k = 0; k < 8000; ++k) {
    whole.push_back(sample_at(k, {0.0, 0.0, -9.8}, {kTurn + 0.1 * noise.normal(), 0.0, 0.0}));
  }
  auto samples = without(whole, [](std::size_t k) { return k % 10 == 5; });
  fill_gaps(samples);
  // THEN what is put in turns as far in the mean
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 5; k < whole.size(); k += 10) {
    sum += samples[k].rate.x();
    ++count;
    EXPECT_NEAR(samples[k].force.z(), -9.8, 1e-6);
  }
  const double five_sigma = 5.0 * 0.1 / std::sqrt(count);
  EXPECT_NEAR(sum / count, kTurn, five_sigma);
}

TEST(ImuGapsTest, DrawsStraightLinesWhereThereIsLittleToLearnFrom) {
  std::vector<ImuSample> samples{sample_at(0, Vector3::Zero(), Vector3::Zero()),
                                 sample_at(3, {0.0, 3.0, 0.0}, {0.3, 0.0, 0.0})};
  EXPECT_EQ(fill_gaps(samples), 2U);
  ASSERT_EQ(samples.size(), 4U);
  EXPECT_EQ(samples[1].when, kSampleTime);
  EXPECT_NEAR(samples[1].force.y(), 1.0, 1e-12);
  EXPECT_NEAR(samples[2].rate.x(), 0.2, 1e-12);
}

TEST(ImuGapsTest, LeavesLongGapsAndThoseBesideNoNumbers) {
  auto samples = without(shaking(1000), [](std::size_t k) { return (k >= 300 && k < 306) || k == 600; });
  samples[593].force.x() = std::numeric_limits<double>::quiet_NaN();  // sample 599
  const std::size_t before = samples.size();
  EXPECT_EQ(fill_gaps(samples), 0U);
  EXPECT_EQ(samples.size(), before);
}

TEST(ImuGapsTest, LearnsNothingFromSamplesThatAreNoNumbers) {
  const auto whole = shaking(3000);
  auto samples = without(whole, [](std::size_t k) { return k == 1501; });
  for (std::size_t k = 100; k < 1400; k += 50) samples[k].rate.z() = std::numeric_limits<double>::infinity();
  ASSERT_EQ(fill_gaps(samples), 1U);
  EXPECT_LT((samples[1501].rate - whole[1501].rate).norm(), 0.02);
}

}  // namespace
}  // namespace ironbird::scenarios
