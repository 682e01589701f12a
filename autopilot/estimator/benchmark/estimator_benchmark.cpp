#include <benchmark/benchmark.h>

#include <vector>

#include "autopilot/estimator/ekf.hpp"
#include "autopilot/estimator/ekf_measurements.hpp"
#include "autopilot/estimator/error_state_filter.hpp"
#include "autopilot/estimator/scalar_update.hpp"
#include "autopilot/estimator/test/fake_flight.hpp"

namespace ironbird::autopilot {
namespace {

const EkfState kState{{5.0, -3.0, -40.0}, {3.0, 0.5, -0.4}, {0.2, -0.1, 0.7}, {0.01, -0.02, 0.03}};
const EkfInput kInput{{0.1, -0.2, -9.8}, {0.1, 0.3, -0.2}, 9.81};
constexpr double kImuPeriod = 0.0025;  // s

/// One prediction of the 12-state filter as Ekf does it: trigonometry, f, A, transition, covariance, noise.
void EkfPrediction(benchmark::State& state) {
  EkfState::Matrix P = EkfState::Matrix::Identity() * 1.0e-3;
  EkfState x = kState;
  EkfStepNoise noise;
  noise.accelerometer = 1.0e-6;
  noise.gyro = 1.0e-10;
  for (auto _ : state) {
    const EulerTrig at(x.theta);
    const EkfState::Vector x_dot = ekf_dynamics(x, at, kInput);
    ekf_propagate_covariance(P, ekf_transition(ekf_jacobian(x, at, kInput), kImuPeriod));
    ekf_add_noise(P, x, at, noise);
    benchmark::DoNotOptimize(x_dot.data());
    benchmark::DoNotOptimize(P.data());
    benchmark::ClobberMemory();
    P.setIdentity();
    P *= 1.0e-3;
  }
}
BENCHMARK(EkfPrediction);

template <int Size>
void ScalarUpdateOf(benchmark::State& state) {
  using Matrix = Eigen::Matrix<double, Size, Size>;
  Matrix P = Matrix::Identity();
  for (auto _ : state) {
    ScalarUpdate<Size> update;
    update.fuse_component(P, 0.01, 2, -11.0, 1.0e8);
    benchmark::DoNotOptimize(update.correction.data());
    benchmark::DoNotOptimize(P.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(ScalarUpdateOf<EkfState::kSize>);
BENCHMARK(ScalarUpdateOf<ErrorState::kSize>);

/// One error-state prediction: nominal state, transition, covariance.
void ErrorStatePrediction(benchmark::State& state) {
  ErrorState::Matrix P = ErrorState::Matrix::Identity() * 1.0e-3;
  const ErrorState::Vector noise = ErrorState::Vector::Constant(1.0e-9);
  const WalkDecay decay{.gnss = 0.99999, .baro = 0.99999};
  ErrorState x;
  for (auto _ : state) {
    Matrix3 R_mid;
    ErrorState next = error_state_propagate(x, kInput, decay, kImuPeriod, R_mid);
    error_state_propagate_covariance(P, error_transition(x, kInput, R_mid, decay, kImuPeriod), noise);
    benchmark::DoNotOptimize(next);
    benchmark::DoNotOptimize(P.data());
    benchmark::ClobberMemory();
    P.setIdentity();
    P *= 1.0e-3;
  }
}
BENCHMARK(ErrorStatePrediction);

/// A whole filter over ten seconds of a recorded flight: IMU 400 Hz, compass 50, barometer 100, fixes 10 Hz.
/// The counter is the time per simulated second.
template <class Filter>
void SimulatedSecond(benchmark::State& state) {
  FakeSensors sensors(1);
  Filter filter;
  while (sensors.time() < 8.0) filter.run(sensors.next());
  std::vector<SensorFrame> frames;
  while (sensors.time() < 18.0) frames.push_back(sensors.next());
  const Time length = frames.back().imu.stamp - frames.front().imu.stamp + std::chrono::microseconds(2500);
  for (auto _ : state) {
    for (SensorFrame& frame : frames) {
      benchmark::DoNotOptimize(filter.run(frame));
      frame.imu.stamp += length;
      if (frame.gnss) frame.gnss->stamp += length;
    }
  }
  state.counters["per_simulated_second"] =
      benchmark::Counter(10.0, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(SimulatedSecond<Ekf>)->Unit(benchmark::kMillisecond);
BENCHMARK(SimulatedSecond<ErrorStateFilter>)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ironbird::autopilot
