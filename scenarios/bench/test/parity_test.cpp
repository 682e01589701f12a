// The estimator error of the reference's model over many runs, against what its sensors' random walks are on
// paper. One run is one draw of these walks; what can be held is their distribution.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/modules.hpp"
#include "scenarios/bench/bench.hpp"

namespace ironbird::scenarios {
namespace {

constexpr int kRuns = 100;

// The reference's sensors; models/rosflight_multirotor/sensors.toml.
constexpr double kFixStep = 0.21 * 0.1;                   // m, of the Gauss-Markov process, every 0.1 s
constexpr double kFixTimeConstant = 1100.0;               // s
constexpr double kPressureDiffusion = 0.1 * 0.1 * 100.0;  // Pa^2/s: 0.1 Pa at 100 Hz
constexpr double kPressurePerMetre = 1.070 * 9.81;        // Pa/m at 1387 m

constexpr double kWait = 3.0;        // s, from origin and ground pressure to the take-off
constexpr double kAirborne = 480.5;  // s
// The height follows the barometer this slowly: a diffusion of 1.25e-5 m^2/s (satellite velocity, process
// noise) against 0.0069 m^2 s (10 Pa at 100 Hz).
constexpr double kHeightLag = 23.0;  // s

constexpr double kStandardErrors = 3.0;

using Figures = std::map<std::string, double>;

Figures fly(std::uint64_t seed, const std::vector<std::pair<std::string, std::string>>& settings) {
  const autopilot::Modules modules = autopilot::standard_modules();
  const std::filesystem::path file =
      std::filesystem::path(IRONBIRD_SOURCE_DIR) / "scenarios/library/paper/parity_eight_minutes.toml";
  const LoadedScenario loaded = load_scenario(file, Overrides{settings, seed}, modules);
  Bench bench(loaded, modules, {});
  Figures figures;
  for (const Metric& metric : bench.fly().metrics) figures[metric.name] = metric.value;
  return figures;
}

/// The error that is there without any noise.
Figures fly_quietly() {
  return fly(1, {{"sensors.gnss.horizontal.instability_sigma", "0"},
                 {"sensors.gnss.velocity.noise_sigma", "0"},
                 {"sensors.barometer.error.noise_sigma", "0"},
                 {"sensors.barometer.error.walk_per_sample", "0"},
                 {"sensors.magnetometer.error.instability_sigma", "0"},
                 {"sensors.imu.accelerometer.noise_sigma", "0"},
                 {"sensors.imu.gyro.noise_sigma", "0"},
                 {"sensors.imu.gyro.instability_sigma", "0"}});
}

double square(double x) {
  return x * x;
}

/// Mean square of one axis of the satellite fixes' walk since the origin, over the flight: the mean over s of
/// sigma^2 (1 - exp(-2 s/tau)).
double expected_horizontal() {
  const double tau = kFixTimeConstant;
  const double variance = square(kFixStep) / -std::expm1(-2.0 * 0.1 / tau);
  const double area = 0.5 * tau * (std::exp(-2.0 * kWait / tau) - std::exp(-2.0 * (kWait + kAirborne) / tau));
  return variance * (1.0 - area / kAirborne);
}

/// Mean square of the barometer's walk behind a lag, q (t - 3/2 lag), over the flight, in m^2.
double expected_walk_down() {
  return kPressureDiffusion * (kWait + 0.5 * kAirborne - 1.5 * kHeightLag) / square(kPressurePerMetre);
}

class ParityTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    for (int seed = 1; seed <= kRuns; ++seed) runs_.push_back(fly(static_cast<std::uint64_t>(seed), {}));
  }

  static std::vector<double> of(const std::string& metric) {
    std::vector<double> values;
    for (const Figures& run : runs_) values.push_back(run.at(metric));
    return values;
  }

  static double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }

  /// The mean square of `metric` agrees with `expected` as well as so many runs can tell.
  static void expect_mean_square(const std::string& metric, double expected) {
    std::vector<double> squares = of(metric);
    for (double& value : squares) value = square(value);
    const double found = mean(squares);
    double scatter = 0.0;
    for (const double value : squares) scatter += square(value - found);
    const double standard_error = std::sqrt(scatter) / kRuns;
    EXPECT_NEAR(found, expected, kStandardErrors * standard_error) << metric;
    // So many runs must tell something.
    EXPECT_LT(standard_error, 0.2 * expected) << metric;
  }

  static std::vector<Figures> runs_;
};

std::vector<Figures> ParityTest::runs_;

TEST_F(ParityTest, DriftsWithTheSatelliteFixesNorthAndEast) {
  expect_mean_square("estimate_north_rms_m", expected_horizontal());
  expect_mean_square("estimate_east_rms_m", expected_horizontal());
}

TEST_F(ParityTest, DriftsWithTheBarometerDownAroundTheErrorOfTheAirDensity) {
  const double density = fly_quietly().at("estimate_down_rms_m");
  EXPECT_NEAR(density, 0.84, 0.05);  // 12.7 % of 6.6 m
  expect_mean_square("estimate_down_rms_m", square(density) + expected_walk_down());
}

TEST_F(ParityTest, HasTheReferencesPositionErrorAsAnOrdinaryDraw) {
  constexpr double kReference = 1.74;
  const std::vector<double> position = of("estimate_position_rms_m");
  const auto below =
      std::count_if(position.begin(), position.end(), [](double error) { return error < kReference; });
  EXPECT_GT(below, kRuns / 4);
  EXPECT_LT(below, kRuns * 3 / 4);
}

TEST_F(ParityTest, HasTheReferencesVelocityAndAttitudeErrorsInTheMean) {
  EXPECT_NEAR(mean(of("estimate_velocity_total_rms_mps")), 0.013, 0.002);
  const double attitude = mean(of("estimate_attitude_rms_deg"));
  EXPECT_GT(attitude, 0.225);  // 0.23 to 0.27 deg, to the digits given
  EXPECT_LT(attitude, 0.275);
}

}  // namespace
}  // namespace ironbird::scenarios
