// The estimator error of the reference's model over many runs, against what its sensors' random walks are on
// paper. One run is one draw of these walks; what can be held is their distribution.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/modules.hpp"
#include "scenarios/bench/bench.hpp"
#include "simulator/random/stream.hpp"

namespace ironbird::scenarios {
namespace {

constexpr int kRuns = 100;

// What the position error of a run like the reference's and the paper's, 1.74 and 1.72 m, is to be.
constexpr double kGoal = 1.7;       // m
constexpr double kTolerance = 0.2;  // m

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

Figures fly(std::optional<std::uint64_t> seed,
            const std::vector<std::pair<std::string, std::string>>& settings) {
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

/// What flights on paper come to: mean squares of one draw of the walks, m^2.
struct PaperFlight {
  double horizontal = 0.0;  // of one axis
  double down = 0.0;
  double position = 0.0;
};

/// One draw of the three walks over the flight.
/// @param density  the error of the height that is there in every flight, m
PaperFlight draw_on_paper(simulator::Stream& stream, double density) {
  constexpr double kStep = 0.5;  // s, short against every time constant
  const double keep = std::exp(-kStep / kFixTimeConstant);
  const double fix_step = kFixStep * std::sqrt(kStep / 0.1);
  const double height_step = std::sqrt(kPressureDiffusion * kStep) / kPressurePerMetre;
  double north = 0.0, east = 0.0, height = 0.0, followed = 0.0;
  PaperFlight sum;
  const int wait = static_cast<int>(kWait / kStep), steps = static_cast<int>(kAirborne / kStep);
  for (int i = -wait; i < steps; ++i) {
    north = keep * north + fix_step * stream.normal();
    east = keep * east + fix_step * stream.normal();
    height += height_step * stream.normal();
    followed += (height - followed) * kStep / kHeightLag;
    if (i < 0) continue;
    const double down = square(followed + density);
    sum.horizontal += square(north) / steps;
    sum.down += down / steps;
    sum.position += (square(north) + square(east) + down) / steps;
  }
  return sum;
}

struct Spread {
  double mean = 0.0;
  double deviation = 0.0;  // of one draw
};

/// Of a figure of many flights on paper.
template <class Figure>
Spread on_paper(double density, const Figure& figure) {
  constexpr int kDraws = 4000;  // so that the paper's own scatter is a sixth of that of the flights
  simulator::Stream stream(1, "parity on paper");
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = figure(draw_on_paper(stream, density));
    sum += value;
    squares += square(value);
  }
  const double mean = sum / kDraws;
  return {mean, std::sqrt(squares / kDraws - square(mean))};
}

// What the scenario says to who flies it as it ships: one draw; a quarter of all draws are within the
// tolerance. What draws the noise in another order takes it out three times of four and is no fault: then
// docs/results.md has to say the new figure, and the median of a hundred draws is what holds.
TEST(ParityAsShippedTest, IsOffByWhatTheReferenceIs) {
  const Figures figures = fly(std::nullopt, {});
  EXPECT_NEAR(figures.at("estimate_position_rms_m"), kGoal, kTolerance);
  EXPECT_NEAR(figures.at("estimate_velocity_total_rms_mps"), 0.013, 0.002);
  // 0.208 deg, less than the reference's 0.23 to 0.27; of all draws nine of ten lie here.
  EXPECT_GT(figures.at("estimate_attitude_rms_deg"), 0.195);
  EXPECT_LT(figures.at("estimate_attitude_rms_deg"), 0.267);
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

  /// The mean of the flights lies within standard errors of the calculated one.
  static void expect_mean(const std::vector<double>& found, double expected, double deviation) {
    EXPECT_NEAR(mean(found), expected, kStandardErrors * deviation / std::sqrt(kRuns));
  }

  static std::vector<double> squares_of(const std::string& metric) {
    std::vector<double> squares = of(metric);
    for (double& value : squares) value = square(value);
    return squares;
  }

  static std::vector<Figures> runs_;
};

std::vector<Figures> ParityTest::runs_;

TEST_F(ParityTest, DriftsWithTheSatelliteFixesNorthAndEast) {
  const double deviation = on_paper(0.0, [](const PaperFlight& f) { return f.horizontal; }).deviation;
  expect_mean(squares_of("estimate_north_rms_m"), expected_horizontal(), deviation);
  expect_mean(squares_of("estimate_east_rms_m"), expected_horizontal(), deviation);
}

TEST_F(ParityTest, DriftsWithTheBarometerDownAroundTheErrorOfTheAirDensity) {
  const double density = fly_quietly().at("estimate_down_rms_m");
  EXPECT_NEAR(density, 0.84, 0.05);  // 12.7 % of 6.6 m
  const double deviation = on_paper(density, [](const PaperFlight& f) { return f.down; }).deviation;
  expect_mean(squares_of("estimate_down_rms_m"), square(density) + expected_walk_down(), deviation);
}

TEST_F(ParityTest, HasTheCalculatedPositionErrorAndTheReferencesAsAnOrdinaryDraw) {
  constexpr double kReference = 1.74;  // m
  const double density = fly_quietly().at("estimate_down_rms_m");
  const Spread position = on_paper(density, [](const PaperFlight& f) { return std::sqrt(f.position); });
  const std::vector<double> flown = of("estimate_position_rms_m");
  expect_mean(flown, position.mean, position.deviation);
  const Spread below =
      on_paper(density, [](const PaperFlight& f) { return std::sqrt(f.position) < kReference ? 1.0 : 0.0; });
  std::vector<double> flown_below = flown;
  for (double& error : flown_below) error = error < kReference ? 1.0 : 0.0;
  expect_mean(flown_below, below.mean, below.deviation);
  const Spread within = on_paper(density, [](const PaperFlight& f) {
    return std::abs(std::sqrt(f.position) - kGoal) < kTolerance ? 1.0 : 0.0;
  });
  EXPECT_NEAR(within.mean, 0.25, 0.03) << "as docs/results.md says";
  EXPECT_NEAR(below.mean, 0.45, 0.03) << "an ordinary draw, as docs/results.md says";
}

// The mean is not within the tolerance: a few runs are off by 3 and 4 m.
TEST_F(ParityTest, HasTheReferencesPositionErrorInTheMedian) {
  std::vector<double> flown = of("estimate_position_rms_m");
  std::sort(flown.begin(), flown.end());
  EXPECT_NEAR(0.5 * (flown[kRuns / 2 - 1] + flown[kRuns / 2]), kGoal, kTolerance);
}

// Nothing on paper says these: they are the reference's figures, 0.23 to 0.27 deg to the digits given, about
// 0.013 m/s.
TEST_F(ParityTest, HasTheReferencesVelocityAndAttitudeErrorsInTheMean) {
  EXPECT_NEAR(mean(of("estimate_velocity_total_rms_mps")), 0.013, 0.002);
  const double attitude = mean(of("estimate_attitude_rms_deg"));
  EXPECT_GT(attitude, 0.225);
  EXPECT_LT(attitude, 0.275);
}

}  // namespace
}  // namespace ironbird::scenarios
