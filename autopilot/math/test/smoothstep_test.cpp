#include "autopilot/math/smoothstep.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ironbird::autopilot {
namespace {

constexpr double kSmoothstepRoundOff = 1e-14;
constexpr double kStep = 1e-5;
constexpr double kCentralDifference = 1e-8;  // of order kStep^2 times the third derivative, plus rounding

TEST(SmoothstepTest, BeginsAndEndsAtRest) {
  for (const double tau : {-1.0, 0.0, 1.0, 2.0}) {
    const Smoothstep s = smoothstep(tau);
    EXPECT_EQ(s.value, tau > 0.5 ? 1.0 : 0.0);
    EXPECT_EQ(s.first, 0.0);
    EXPECT_EQ(s.second, 0.0);
  }
}

TEST(SmoothstepTest, IsHalfWayAtHalfTimeWithItsPeakRate) {
  const Smoothstep s = smoothstep(0.5);
  EXPECT_NEAR(s.value, 0.5, kSmoothstepRoundOff);
  EXPECT_NEAR(s.first, Smoothstep::kPeakFirst, kSmoothstepRoundOff);
  EXPECT_NEAR(s.second, 0.0, kSmoothstepRoundOff);
}

TEST(SmoothstepTest, HasItsPeakCurvatureWhereTheThirdDerivativeIsZero) {
  EXPECT_NEAR(smoothstep(0.5 - std::sqrt(3.0) / 6.0).second, Smoothstep::kPeakSecond,
              kSmoothstepRoundOff * 10.0);
  EXPECT_NEAR(smoothstep(0.5 + std::sqrt(3.0) / 6.0).second, -Smoothstep::kPeakSecond,
              kSmoothstepRoundOff * 10.0);
}

TEST(SmoothstepTest, HasDerivativesThatAgreeWithCentralDifferences) {
  for (double tau = 0.05; tau < 1.0; tau += 0.05) {
    const Smoothstep before = smoothstep(tau - kStep);
    const Smoothstep after = smoothstep(tau + kStep);
    EXPECT_NEAR(smoothstep(tau).first, (after.value - before.value) / (2.0 * kStep), kCentralDifference);
    EXPECT_NEAR(smoothstep(tau).second, (after.first - before.first) / (2.0 * kStep), kCentralDifference);
  }
}

TEST(SmoothstepTest, NeverExceedsTheLimitsThatItsDurationWasMadeFor) {
  constexpr double kRise = 0.25;
  constexpr double kMostJerk = 2.0 / kRise;
  for (const double distance : {0.01, 1.0, 2.5, 20.2, 500.0}) {
    const double duration = smoothstep_duration(distance, 3.0, 2.0, kRise);
    double peak_rate = 0.0;
    double peak_acceleration = 0.0;
    double peak_jerk = 0.0;
    double last = 0.0;
    for (int i = 0; i <= 10000; ++i) {
      const Smoothstep s = smoothstep(i / 10000.0);
      peak_rate = std::max(peak_rate, s.first * distance / duration);
      peak_acceleration = std::max(peak_acceleration, std::abs(s.second) * distance / (duration * duration));
      const double jerk = 1e4 * (s.second - last) * distance / (duration * duration * duration);
      peak_jerk = std::max(peak_jerk, std::abs(jerk));
      last = s.second;
    }
    EXPECT_LE(peak_rate, 3.0 + 1e-12);
    EXPECT_LE(peak_acceleration, 2.0 + 1e-12);
    EXPECT_LE(peak_jerk, kMostJerk);
    EXPECT_GT(std::max({peak_rate / 3.0, peak_acceleration / 2.0, peak_jerk / kMostJerk}), 0.999)
        << "one limit is met";
  }
}

TEST(SmoothstepTest, HasItsGreatestJerkAtItsEnds) {
  EXPECT_NEAR(smoothstep(kStep).second / kStep, Smoothstep::kPeakThird, 0.01);
  EXPECT_NEAR(smoothstep(1.0 - kStep).second / kStep, -Smoothstep::kPeakThird, 0.01);
}

TEST(SmoothstepTest, LastsAsLongAsBeforeWhenTheAccelerationMayBeThereAtOnce) {
  EXPECT_EQ(smoothstep_duration(0.01, 3.0, 2.0, 0.0), std::sqrt(Smoothstep::kPeakSecond * 0.01 / 2.0));
}

TEST(SmoothstepTest, NeedsNoTimeForNoDistance) {
  EXPECT_EQ(smoothstep_duration(0.0, 3.0, 2.0, 0.3), 0.0);
}

}  // namespace
}  // namespace ironbird::autopilot
