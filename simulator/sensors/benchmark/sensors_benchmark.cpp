#include <benchmark/benchmark.h>

#include "ci/yardstick/in_turns.hpp"
#include "simulator/sensors/sensor_suite.hpp"

namespace ironbird::simulator {
namespace {

constexpr Time kTick = std::chrono::microseconds(2500);

/// The noise sources of the X650's sensors, at its rates.
SensorSuiteParams usual() {
  SensorSuiteParams params;
  const auto spoil = [](AxisErrorParams& error) {
    error.turn_on_sigma = 0.03;
    error.instability_sigma = 2e-3;
    error.noise_sigma = 0.02;
    error.resolution = 1e-3;
  };
  spoil(params.imu.accelerometer);
  spoil(params.imu.gyro);
  spoil(params.magnetometer.error);
  spoil(params.barometer.error);
  spoil(params.gnss.horizontal);
  spoil(params.gnss.vertical);
  params.imu.accelerometer_vibration = 1e-6;
  params.imu.gyro_vibration = 2e-8;
  params.imu.accelerometer.full_scale = 235.0;
  params.imu.gyro.full_scale = 35.0;
  params.barometer.error.random_walk = 0.2;
  params.gnss.velocity.noise_sigma = 0.05;
  params.gnss.timing.latency = 0.1;
  params.battery.voltage.noise_sigma = 0.02;
  params.battery.current.noise_sigma = 0.3;
  return params;
}

void AllSensorsOfATickBesideRk4(benchmark::State& state) {
  SensorSuite suite(usual(), SensorSite{}, kTick, 1);
  Truth truth;
  truth.rotor_speed = {470.0, 471.0, 472.0, 473.0};
  truth.w_NB_B = Vector3(0.1, 0.2, 0.3);
  const FaultState faults;
  Readings readings;
  Time now{};
  yardstick::beside_rk4(state, 0.0, [&] {
    now += kTick;
    readings = Readings{};
    suite.sample(truth, now, faults, readings);
    benchmark::DoNotOptimize(readings);
  });
}
BENCHMARK(AllSensorsOfATickBesideRk4)->UseManualTime();

}  // namespace
}  // namespace ironbird::simulator
