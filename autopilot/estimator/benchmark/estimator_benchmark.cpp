#include <benchmark/benchmark.h>

#include <vector>

#include "autopilot/estimator/ekf.hpp"
#include "autopilot/estimator/ekf_measurements.hpp"
#include "autopilot/estimator/error_state_filter.hpp"
#include "autopilot/estimator/scalar_update.hpp"
#include "autopilot/estimator/test/fake_flight.hpp"
#include "ci/yardstick/in_turns.hpp"

namespace ironbird::autopilot {
namespace {

const EkfState kState{{5.0, -3.0, -40.0}, {3.0, 0.5, -0.4}, {0.2, -0.1, 0.7}, {0.01, -0.02, 0.03}};
const EkfInput kInput{{0.1, -0.2, -9.8}, {0.1, 0.3, -0.2}, 9.81};
constexpr double kImuPeriod = 0.0025;  // s

// The goals are a quarter of the reference's prediction and a twentieth of its measurement update, which took
// 2.5 us and 2 us where a step of the hand-written integrator took 0.119 us.
constexpr double kPredictionGoal = 0.25 * 2.5 / 0.119;
constexpr double kUpdateGoal = 0.05 * 2.0 / 0.119;

/// One prediction of the 12-state filter as Ekf does it: f, A, transition, covariance, noise, new state and
/// its trigonometry.
void EkfPredictionBesideRk4(benchmark::State& state) {
  const EkfState::Matrix start = EkfState::Matrix::Identity() * 1.0e-3;
  EkfState::Matrix P = start;
  EkfState x = kState;
  EulerTrig at(x.theta);
  EkfStepNoise noise;
  noise.accelerometer = 1.0e-6;
  noise.gyro = 1.0e-10;
  yardstick::beside_rk4(state, kPredictionGoal, [&] {
    benchmark::DoNotOptimize(x);
    const EkfState::Vector x_dot = ekf_dynamics(x, at, kInput);
    ekf_propagate_covariance(P, ekf_transition(ekf_jacobian(x, at, kInput), kImuPeriod));
    ekf_add_noise(P, x, at, noise);
    const Vector3 theta = kState.theta + kImuPeriod * x_dot.segment<3>(EkfState::kAttitude);
    at = EulerTrig(theta);
    benchmark::DoNotOptimize(P.data());
    benchmark::ClobberMemory();
    P = start;
  });
}
BENCHMARK(EkfPredictionBesideRk4)->UseManualTime();

/// One component of a measurement.
template <int Size>
void update(benchmark::State& state, double goal) {
  using Matrix = Eigen::Matrix<double, Size, Size>;
  Matrix P = Matrix::Identity();
  yardstick::beside_rk4(state, goal, [&] {
    ScalarUpdate<Size> update;
    update.fuse_component(P, 0.01, 2, -11.0, 1.0e8);
    benchmark::DoNotOptimize(update.correction.data());
    benchmark::DoNotOptimize(P.data());
    benchmark::ClobberMemory();
  });
}
void EkfUpdateBesideRk4(benchmark::State& state) {
  update<EkfState::kSize>(state, kUpdateGoal);
}
void ErrorStateUpdateBesideRk4(benchmark::State& state) {
  update<ErrorState::kSize>(state, 0.0);
}
BENCHMARK(EkfUpdateBesideRk4)->UseManualTime();
BENCHMARK(ErrorStateUpdateBesideRk4)->UseManualTime();

/// One error-state prediction: nominal state, transition, covariance.
void ErrorStatePredictionBesideRk4(benchmark::State& state) {
  const ErrorState::Matrix start = ErrorState::Matrix::Identity() * 1.0e-3;
  ErrorState::Matrix P = start;
  const ErrorState::Vector noise = ErrorState::Vector::Constant(1.0e-9);
  const WalkDecay decay{.gnss = 0.99999, .baro = 0.99999};
  ErrorState x;
  yardstick::beside_rk4(state, 0.0, [&] {
    Matrix3 R_mid;
    ErrorState next = error_state_propagate(x, kInput, decay, kImuPeriod, R_mid);
    error_state_propagate_covariance(P, error_transition(x, kInput, R_mid, decay, kImuPeriod), noise);
    benchmark::DoNotOptimize(next);
    benchmark::DoNotOptimize(P.data());
    benchmark::ClobberMemory();
    P = start;
  });
}
BENCHMARK(ErrorStatePredictionBesideRk4)->UseManualTime();

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
