#include "simulator/sensors/error_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace ironbird::simulator {
namespace {

/// Relative half-width of a 5-sigma band around a standard deviation estimated from n independent samples.
double five_sigma(double n) {
  return 5.0 / std::sqrt(2.0 * n);
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i] * b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
  }
  return ab / std::sqrt(aa * bb);
}

std::vector<double> errors_of(AxisError axis, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(axis.next());
  return values;
}

struct GaussMarkovCase {
  const char* name;
  double period;
  double time_constant;
};

class GaussMarkovTest : public ::testing::TestWithParam<GaussMarkovCase> {};

TEST_P(GaussMarkovTest, HasItsSigmaFromTheFirstSampleToTheLast) {
  const auto [name, period, time_constant] = GetParam();
  constexpr int kRuns = 4000;
  std::vector<double> first, last;
  for (int run = 0; run < kRuns; ++run) {
    GaussMarkov process(2.0, time_constant, period, GaussMarkovScheme::kStationary,
                        static_cast<std::uint64_t>(run), "process");
    first.push_back(process.next());
    for (int i = 0; i < 49; ++i) process.next();
    last.push_back(process.next());
  }
  EXPECT_NEAR(root_mean_square(first), 2.0, 2.0 * five_sigma(kRuns));
  EXPECT_NEAR(root_mean_square(last), 2.0, 2.0 * five_sigma(kRuns));
}

TEST_P(GaussMarkovTest, ForgetsExponentially) {
  const auto [name, period, time_constant] = GetParam();
  constexpr int kRuns = 4000;
  constexpr int kSteps = 20;
  std::vector<double> first, later;
  for (int run = 0; run < kRuns; ++run) {
    GaussMarkov process(1.0, time_constant, period, GaussMarkovScheme::kStationary,
                        static_cast<std::uint64_t>(run), "process");
    first.push_back(process.next());
    double value = 0.0;
    for (int i = 0; i < kSteps; ++i) value = process.next();
    later.push_back(value);
  }
  const double expected = std::exp(-kSteps * period / time_constant);
  EXPECT_NEAR(correlation(first, later), expected, 5.0 / std::sqrt(kRuns));
}

INSTANTIATE_TEST_SUITE_P(Periods, GaussMarkovTest,
                         ::testing::Values(GaussMarkovCase{"Fine", 0.0025, 0.05},
                                           GaussMarkovCase{"Coarse", 0.1, 0.05},
                                           GaussMarkovCase{"Slow", 0.1, 1100.0}),
                         [](const auto& sample) { return sample.param.name; });

/// The table of the reference simulator's processes: sigma T / sqrt(1 - exp(-2 T/tau)).
struct ReferenceCase {
  const char* name;
  double sigma, time_constant, period, stationary;
};

class ReferenceSchemeTest : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(ReferenceSchemeTest, ReachesTheStationaryDeviationOfTheRecursionAsCoded) {
  const auto [name, sigma, time_constant, period, stationary] = GetParam();
  constexpr int kRuns = 2000;
  const int steps = static_cast<int>(5.0 * time_constant / period);
  std::vector<double> last;
  for (int run = 0; run < kRuns; ++run) {
    GaussMarkov process(sigma, time_constant, period, GaussMarkovScheme::kNoiseTimesPeriod,
                        static_cast<std::uint64_t>(run), "process");
    double value = 0.0;
    for (int i = 0; i < steps; ++i) value = process.next();
    last.push_back(value);
  }
  EXPECT_NEAR(root_mean_square(last) / stationary, 1.0, five_sigma(kRuns));
}

INSTANTIATE_TEST_SUITE_P(Processes, ReferenceSchemeTest,
                         ::testing::Values(ReferenceCase{"Magnetometer", 3e-6, 1.0 / 7.0, 0.02, 1.22e-7},
                                           ReferenceCase{"Gyro", 0.033, 0.05, 0.0025, 2.675e-4},
                                           ReferenceCase{"GnssShortened", 0.21, 11.0, 0.1, 0.1565}),
                         [](const auto& sample) { return sample.param.name; });

TEST(ReferenceDriftTest, DriftsFromZeroAsTheReferenceDoes) {
  constexpr int kRuns = 2000;
  std::vector<double> after_a_minute;
  for (int run = 0; run < kRuns; ++run) {
    GaussMarkov process(0.21, 1100.0, 0.1, GaussMarkovScheme::kNoiseTimesPeriod,
                        static_cast<std::uint64_t>(run), "process");
    double value = 0.0;
    for (int i = 0; i < 600; ++i) value = process.next();
    after_a_minute.push_back(value);
  }
  EXPECT_NEAR(root_mean_square(after_a_minute), 0.50, 0.50 * five_sigma(kRuns));
}

TEST(AxisErrorTest, ScalesItsNoiseDensityWithTheSampleRate) {
  constexpr int kSamples = 40000;
  AxisErrorParams params;
  params.noise_density = 0.01;
  for (const double rate : {50.0, 400.0, 8000.0}) {
    const double expected = 0.01 * std::sqrt(rate);
    const double sigma = root_mean_square(errors_of(AxisError(params, 0.0, 1.0 / rate, 3, "axis"), kSamples));
    EXPECT_NEAR(sigma / expected, 1.0, five_sigma(kSamples)) << rate;
  }
}

/// Deviation of the mean over `count` samples falls with the root of the averaging time: the -1/2 slope of an
/// Allan plot, with the density where the line crosses one second.
TEST(AxisErrorTest, AveragesItsWhiteNoiseAwayWithTheRootOfTime) {
  constexpr double kRate = 400.0;
  constexpr int kClusters = 2000;
  AxisErrorParams params;
  params.noise_density = 0.002;
  AxisError axis(params, 0.0, 1.0 / kRate, 11, "axis");
  for (const int count : {4, 40, 400}) {
    std::vector<double> means;
    for (int cluster = 0; cluster < kClusters; ++cluster) {
      double sum = 0.0;
      for (int i = 0; i < count; ++i) sum += axis.next();
      means.push_back(sum / count);
    }
    const double expected = 0.002 / std::sqrt(count / kRate);
    EXPECT_NEAR(root_mean_square(means) / expected, 1.0, five_sigma(kClusters)) << count;
  }
}

TEST(AxisErrorTest, WalksWithTheRootOfTimeWhateverTheRate) {
  constexpr int kRuns = 3000;
  AxisErrorParams params;
  params.random_walk = 0.3;
  for (const double rate : {10.0, 100.0}) {
    for (const double duration : {0.5, 4.0}) {
      std::vector<double> ends;
      for (int run = 0; run < kRuns; ++run) {
        AxisError axis(params, 0.0, 1.0 / rate, static_cast<std::uint64_t>(run), "axis");
        double value = 0.0;
        for (int i = 0; i < static_cast<int>(duration * rate); ++i) value = axis.next();
        ends.push_back(value);
      }
      const double expected = 0.3 * std::sqrt(duration);
      EXPECT_NEAR(root_mean_square(ends) / expected, 1.0, five_sigma(kRuns)) << rate << " Hz " << duration;
    }
  }
}

TEST(AxisErrorTest, WalksPerSampleWhateverThePeriodWhenAskedTo) {
  constexpr int kRuns = 3000;
  AxisErrorParams params;
  params.walk_per_sample = 0.1;
  for (const double period : {0.001, 1.0}) {
    std::vector<double> ends;
    for (int run = 0; run < kRuns; ++run) {
      AxisError axis(params, 0.0, period, static_cast<std::uint64_t>(run), "axis");
      double value = 0.0;
      for (int i = 0; i < 100; ++i) value = axis.next();
      ends.push_back(value);
    }
    EXPECT_NEAR(root_mean_square(ends), 1.0, five_sigma(kRuns)) << period;
  }
}

TEST(AxisErrorTest, DrawsItsTurnOnBiasOncePerRun) {
  constexpr int kRuns = 5000;
  AxisErrorParams normal, uniform;
  normal.turn_on_sigma = 0.5;
  uniform.turn_on_range = 0.6;
  std::vector<double> from_normal, from_uniform;
  double largest = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    AxisError first(normal, 0.0, 0.01, static_cast<std::uint64_t>(run), "axis");
    AxisError second(uniform, 0.0, 0.01, static_cast<std::uint64_t>(run), "axis");
    from_normal.push_back(first.next());
    from_uniform.push_back(second.next());
    EXPECT_EQ(from_normal.back(), first.next());
    largest = std::max(largest, std::abs(from_uniform.back()));
  }
  EXPECT_NEAR(root_mean_square(from_normal), 0.5, 0.5 * five_sigma(kRuns));
  EXPECT_NEAR(root_mean_square(from_uniform), 0.6 / std::sqrt(3.0), 0.6 * five_sigma(kRuns));
  EXPECT_LT(largest, 0.6);
  EXPECT_GT(largest, 0.59);
}

TEST(AxisErrorTest, LeavesEverySourceAloneWhenAnotherChanges) {
  AxisErrorParams white_only, both, walk_only;
  white_only.noise_sigma = 1.0;
  walk_only.walk_per_sample = 1.0;
  both.noise_sigma = 1.0;
  both.walk_per_sample = 1.0;
  AxisError white(white_only, 0.0, 0.01, 7, "axis"), walk(walk_only, 0.0, 0.01, 7, "axis"),
      sum(both, 0.0, 0.01, 7, "axis");
  constexpr double kRoundOff = 1e-12;
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(sum.next(), white.next() + walk.next(), kRoundOff);
}

TEST(AxisErrorTest, HasSourcesAndAxesThatDoNotCorrelate) {
  constexpr int kSamples = 40000;
  constexpr double kFiveSigma = 5.0 / 200.0;  // 5 / sqrt(kSamples)
  AxisErrorParams params;
  params.noise_sigma = 1.0;
  const std::vector<double> x = errors_of(AxisError(params, 0.0, 0.01, 1, "gyro/x"), kSamples);
  const std::vector<double> y = errors_of(AxisError(params, 0.0, 0.01, 1, "gyro/y"), kSamples);
  const std::vector<double> other_seed = errors_of(AxisError(params, 0.0, 0.01, 2, "gyro/x"), kSamples);
  EXPECT_NEAR(correlation(x, y), 0.0, kFiveSigma);
  EXPECT_NEAR(correlation(x, other_seed), 0.0, kFiveSigma);
  std::vector<double> shifted(x.begin() + 1, x.end());
  shifted.push_back(x.front());
  EXPECT_NEAR(correlation(x, shifted), 0.0, kFiveSigma);
}

TEST(AxisErrorTest, QuantisesToTheNearestStepAndLimitsToTheFullScale) {
  AxisErrorParams params;
  params.resolution = 0.25;
  params.full_scale = 2.0;
  const AxisError axis(params, 0.0, 0.01, 1, "axis");
  EXPECT_EQ(axis.read_out(0.12), 0.0);
  EXPECT_EQ(axis.read_out(0.13), 0.25);
  EXPECT_EQ(axis.read_out(-0.13), -0.25);
  EXPECT_EQ(axis.read_out(1.9), 2.0);
  EXPECT_EQ(axis.read_out(17.0), 2.0);
  EXPECT_EQ(axis.read_out(-17.0), -2.0);
  EXPECT_TRUE(std::isnan(axis.read_out(std::nan(""))));
}

TEST(AxisErrorTest, AddsTheVarianceOfRoundingToASmoothSignal) {
  constexpr int kSamples = 20000;
  AxisErrorParams params;
  params.resolution = 0.1;
  const AxisError axis(params, 0.0, 0.01, 1, "axis");
  std::vector<double> rounding;
  for (int i = 0; i < kSamples; ++i) {
    const double value = 1.2345678e-3 * i;
    rounding.push_back(axis.read_out(value) - value);
  }
  EXPECT_NEAR(root_mean_square(rounding), 0.1 / std::sqrt(12.0), 1e-3 * 0.1);
}

TEST(VectorErrorTest, IsPerfectByDefault) {
  VectorError error(VectorErrorParams<AccelerationUnits>{}, 0.0025, 1, "triad");
  const Vector3 value(1.0, -2.0, 9.81);
  EXPECT_EQ(error.apply(value, Vector3::Zero()), value);
}

TEST(VectorErrorTest, ScalesAndTurnsBeforeItAddsTheBias) {
  VectorErrorParams<AccelerationUnits> params;
  params.scale = Vector3(0.01, -0.02, 0.03);
  params.misalignment = Vector3(0.0, 0.0, 0.1);
  params.bias = Vector3(0.5, 0.6, 0.7);
  VectorError error(params, 0.0025, 1, "triad");
  const Vector3 reading = error.apply(Vector3(1.0, 0.0, 2.0), Vector3(0.0, 1.0, 0.0));
  // Axes turned by +0.1 rad about z see a vector along x turned by -0.1 rad.
  constexpr double kRoundOff = 1e-14;
  EXPECT_NEAR(reading.x(), 1.01 * std::cos(0.1) + 0.5, kRoundOff);
  EXPECT_NEAR(reading.y(), -0.98 * std::sin(0.1) + 0.6 + 1.0, kRoundOff);
  EXPECT_NEAR(reading.z(), 1.03 * 2.0 + 0.7, kRoundOff);
}

TEST(VectorErrorTest, LetsTheDecayingBiasDieOut) {
  VectorErrorParams<AngularRateUnits> params;
  params.decaying_bias = Vector3(0.003, -0.002, 0.001);
  params.decaying_bias_time_constant = 4.0;
  VectorError error(params, 0.0025, 1, "triad");
  Vector3 reading;
  for (int i = 0; i < 1600; ++i) reading = error.apply(Vector3::Zero(), Vector3::Zero());
  // (1 - T/(T + tau))^(t/T) -> exp(-t/tau) but for terms of order T/tau.
  const Vector3 expected = params.decaying_bias * std::exp(-1.0);
  EXPECT_NEAR((reading - expected).norm(), 0.0, 1e-3 * expected.norm());
}

TEST(VectorErrorTest, DrawsScaleAndMisalignmentOncePerRun) {
  constexpr int kRuns = 2000;
  VectorErrorParams<AngularRateUnits> params;
  params.scale_sigma = 0.01;
  std::vector<double> gains;
  for (int run = 0; run < kRuns; ++run) {
    VectorError error(params, 0.0025, static_cast<std::uint64_t>(run), "triad");
    gains.push_back(error.apply(Vector3::UnitY(), Vector3::Zero()).y() - 1.0);
  }
  EXPECT_NEAR(root_mean_square(gains), 0.01, 0.01 * five_sigma(kRuns));
}

TEST(VectorErrorTest, TakesTheWhiteNoiseOfEachSampleFromItsCaller) {
  VectorErrorParams<AngularRateUnits> params;
  params.noise_sigma = 1.0;
  VectorError error(params, 0.0025, 5, "triad");
  EXPECT_EQ(error.apply(Vector3::UnitX(), Vector3::Zero(), 0.0), Vector3(Vector3::UnitX()));
  EXPECT_NE(error.apply(Vector3::UnitX(), Vector3::Zero()), Vector3(Vector3::UnitX()));
}

}  // namespace
}  // namespace ironbird::simulator
