#include "simulator/sensors/sensor_suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

namespace ironbird::simulator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr Time kSuiteTick = microseconds(2500);
const FaultState kNoFaults;

/// Every source of noise switched on.
SensorSuiteParams noisy() {
  SensorSuiteParams params;
  const auto spoil = [](AxisErrorParams& error) {
    error.turn_on_sigma = 0.1;
    error.instability_sigma = 0.2;
    error.random_walk = 0.3;
    error.noise_sigma = 0.4;
  };
  spoil(params.imu.accelerometer);
  spoil(params.imu.gyro);
  spoil(params.magnetometer.error);
  spoil(params.barometer.error);
  spoil(params.gnss.horizontal);
  spoil(params.gnss.vertical);
  spoil(params.gnss.velocity);
  spoil(params.range_finder.error);
  spoil(params.airspeed.error);
  spoil(params.battery.voltage);
  spoil(params.battery.current);
  params.range_finder.timing.enabled = true;
  params.airspeed.timing.enabled = true;
  return params;
}

/// Position tells the time: p_N.x = tick.
Truth truth_at(int tick) {
  Truth truth;
  truth.stamp = tick * kSuiteTick;
  truth.p_NB_N = Vector3(tick, 0.0, -3.0);
  return truth;
}

using FaultsAt = std::function<FaultState(int)>;

std::vector<Readings> run(
    const SensorSuiteParams& params, int ticks, std::uint64_t seed = 1,
    const FaultsAt& faults_at = [](int) { return FaultState{}; }) {
  SensorSuite suite(params, SensorSite{}, kSuiteTick, seed);
  std::vector<Readings> out;
  for (int tick = 1; tick <= ticks; ++tick) {
    Readings readings;
    suite.sample(truth_at(tick), tick * kSuiteTick, faults_at(tick), readings);
    out.push_back(readings);
  }
  return out;
}

template <class Reading>
void expect_same(const std::optional<Reading>& a, const std::optional<Reading>& b, int tick) {
  ASSERT_EQ(a.has_value(), b.has_value()) << tick;
  if (!a) return;
  // Equal to the bit: every member, in the order of the description.
  std::vector<double> first, second;
  const auto list = [](std::vector<double>& numbers) {
    return [&numbers](const char*, const auto& value, auto&&...) {
      using Value = std::decay_t<decltype(value)>;
      if constexpr (std::is_same_v<Value, double>) numbers.push_back(value);
      if constexpr (std::is_same_v<Value, Vector3>) numbers.insert(numbers.end(), value.begin(), value.end());
    };
  };
  Reading::describe(*a, list(first));
  Reading::describe(*b, list(second));
  EXPECT_EQ(first, second) << tick;
  EXPECT_EQ(a->taken, b->taken) << tick;
}

TEST(SensorSuiteTest, DeliversEachSensorAtItsRate) {
  SensorSuiteParams params;
  params.imu.timing.rate = 400.0;
  params.magnetometer.timing.rate = 100.0;
  params.barometer.timing.rate = 50.0;
  params.gnss.timing.rate = 10.0;
  int imu = 0, mag = 0, baro = 0, gnss = 0, range = 0;
  for (const Readings& readings : run(params, 400)) {
    imu += readings.imu.has_value();
    mag += readings.mag.has_value();
    baro += readings.baro.has_value();
    gnss += readings.gnss.has_value();
    range += readings.range.has_value();
  }
  EXPECT_EQ(imu, 400);
  EXPECT_EQ(mag, 100);
  EXPECT_EQ(baro, 50);
  EXPECT_EQ(gnss, 10);
  EXPECT_EQ(range, 0);
}

TEST(SensorSuiteTest, DeliversLateByExactlyTheLatency) {
  for (const int late_ticks : {0, 1, 7, 40, 41, 100}) {
    SensorSuiteParams params;
    params.gnss.timing.latency = late_ticks * seconds(kSuiteTick);
    const std::vector<Readings> out = run(params, 400);
    for (int tick = 1; tick <= 400; ++tick) {
      const std::optional<GnssReading>& gnss = out[static_cast<std::size_t>(tick - 1)].gnss;
      const int taken = tick - late_ticks;
      ASSERT_EQ(gnss.has_value(), taken > 0 && taken % 40 == 0) << tick << " late " << late_ticks;
      if (!gnss) continue;
      EXPECT_EQ(gnss->taken, taken * kSuiteTick);
      constexpr double kRoundOffOfMetres = 2e-9;
      EXPECT_NEAR((gnss->latitude - SensorSite{}.latitude) * kEarthRadius, taken, kRoundOffOfMetres);
    }
  }
}

TEST(SensorSuiteTest, RefusesALatencyLongerThanItsDelayLine) {
  SensorSuiteParams params;
  params.imu.timing.latency = 0.5;
  try {
    SensorSuite(params, SensorSite{}, kSuiteTick, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("sensors.imu.timing.latency = 0.5 s"));
  }
}

TEST(SensorSuiteTest, RefusesARateThatIsNoWholeNumberOfTicks) {
  SensorSuiteParams params;
  params.barometer.timing.rate = 60.0;
  try {
    SensorSuite(params, SensorSite{}, kSuiteTick, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("sensors.barometer.timing.rate = 60 Hz"));
    EXPECT_THAT(refusal.what(), HasSubstr("66.6667 Hz or 57.1429 Hz"));
  }
}

TEST(SensorSuiteTest, RefusesNumbersOutsideTheirBounds) {
  SensorSuiteParams negative, not_a_number, crossed;
  negative.imu.gyro.noise_density = -1.0;
  not_a_number.gnss.horizontal.full_scale = std::nan("");
  crossed.range_finder.minimum = 10.0;
  EXPECT_THROW(SensorSuite(negative, SensorSite{}, kSuiteTick, 1), std::invalid_argument);
  EXPECT_THROW(SensorSuite(not_a_number, SensorSite{}, kSuiteTick, 1), std::invalid_argument);
  EXPECT_THROW(SensorSuite(crossed, SensorSite{}, kSuiteTick, 1), std::invalid_argument);
  EXPECT_THROW(SensorSuite(SensorSuiteParams{}, SensorSite{}, Time::zero(), 1), std::invalid_argument);
}

TEST(SensorSuiteTest, RepeatsItselfToTheBit) {
  const std::vector<Readings> first = run(noisy(), 400), second = run(noisy(), 400);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const int tick = static_cast<int>(i) + 1;
    expect_same(first[i].imu, second[i].imu, tick);
    expect_same(first[i].mag, second[i].mag, tick);
    expect_same(first[i].baro, second[i].baro, tick);
    expect_same(first[i].gnss, second[i].gnss, tick);
    expect_same(first[i].range, second[i].range, tick);
    expect_same(first[i].airspeed, second[i].airspeed, tick);
    expect_same(first[i].battery, second[i].battery, tick);
  }
}

TEST(SensorSuiteTest, DependsOnTheSeed) {
  EXPECT_NE(run(noisy(), 1, 1)[0].imu->f_B, run(noisy(), 1, 2)[0].imu->f_B);
}

TEST(SensorSuiteTest, LeavesTheOtherSensorsAloneWhenOneIsRemovedOrChanged) {
  SensorSuiteParams other = noisy();
  other.range_finder.timing.enabled = false;
  other.imu.timing.rate = 200.0;
  other.magnetometer.error.noise_sigma = 0.0;
  const std::vector<Readings> first = run(noisy(), 400), second = run(other, 400);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const int tick = static_cast<int>(i) + 1;
    expect_same(first[i].baro, second[i].baro, tick);
    expect_same(first[i].gnss, second[i].gnss, tick);
    expect_same(first[i].airspeed, second[i].airspeed, tick);
    expect_same(first[i].battery, second[i].battery, tick);
  }
}

TEST(SensorSuiteTest, DropsSamplesDuringADropoutAndThenGoesOnAsIfThereHadBeenNone) {
  const FaultsAt dropout = [](int tick) {
    FaultState faults;
    const bool out = tick > 100 && tick <= 200;
    faults.imu.dropout = faults.mag.dropout = faults.baro.dropout = faults.gnss.dropout = out;
    return faults;
  };
  const std::vector<Readings> whole = run(noisy(), 400), holed = run(noisy(), 400, 1, dropout);
  for (int tick = 1; tick <= 400; ++tick) {
    const Readings& readings = holed[static_cast<std::size_t>(tick - 1)];
    const Readings& expected = whole[static_cast<std::size_t>(tick - 1)];
    if (tick > 100 && tick <= 200) {
      EXPECT_FALSE(readings.imu || readings.mag || readings.baro || readings.gnss) << tick;
    } else {
      expect_same(readings.imu, expected.imu, tick);
      expect_same(readings.mag, expected.mag, tick);
      expect_same(readings.baro, expected.baro, tick);
      expect_same(readings.gnss, expected.gnss, tick);
    }
    expect_same(readings.airspeed, expected.airspeed, tick);
  }
}

TEST(SensorSuiteTest, DeliversNanDuringANonFiniteFault) {
  const FaultsAt broken = [](int) {
    FaultState faults;
    faults.imu.non_finite = faults.mag.non_finite = faults.baro.non_finite = faults.gnss.non_finite = true;
    return faults;
  };
  const Readings readings = run(noisy(), 40, 1, broken).back();
  EXPECT_TRUE(readings.imu->f_B.array().isNaN().all());
  EXPECT_TRUE(readings.imu->w_NB_B.array().isNaN().all());
  EXPECT_TRUE(readings.mag->m_B.array().isNaN().all());
  EXPECT_TRUE(std::isnan(readings.baro->pressure));
  EXPECT_TRUE(std::isnan(readings.gnss->latitude));
  EXPECT_TRUE(readings.gnss->v_NB_N.array().isNaN().all());
  EXPECT_EQ(readings.imu->taken, 40 * kSuiteTick);
  EXPECT_TRUE(std::isfinite(readings.airspeed->differential_pressure));
}

TEST(SensorSuiteTest, DrawsGnssDriftOfTheAskedSize) {
  // 0.8 m RMS over 300 s from a stationary process: sigma sqrt(2 (1 - exp(-t/tau))).
  constexpr int kRuns = 1000;
  constexpr double kFiveSigma = 0.112;  // 5 / sqrt(2 * kRuns)
  ScalarErrorParams<LengthUnits> params;
  params.instability_sigma = 1.27;
  params.instability_time_constant = 1350.0;
  double sum = 0.0;
  for (int seed = 0; seed < kRuns; ++seed) {
    ScalarError error(params, 0.1, static_cast<std::uint64_t>(seed), "sensors/gnss/north");
    const double start = error.apply(0.0);
    double end = 0.0;
    for (int i = 0; i < 3000; ++i) end = error.apply(0.0);
    sum += (end - start) * (end - start);
  }
  EXPECT_NEAR(std::sqrt(sum / kRuns) / 0.8, 1.0, kFiveSigma);
}

}  // namespace
}  // namespace ironbird::simulator
