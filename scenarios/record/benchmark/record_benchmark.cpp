#include <benchmark/benchmark.h>

#include <filesystem>

#include "autopilot/signals.hpp"
#include "scenarios/record/crc32.hpp"
#include "scenarios/record/recorder.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

std::filesystem::path log_file() {
  return std::filesystem::temp_directory_path() / "ironbird_benchmark.mcap";
}

/// Signals as they look in flight: four waypoints, an angle setpoint, a GNSS fix.
autopilot::Signals flying_signals() {
  autopilot::Signals signals;
  signals.route.waypoints.resize(4);
  signals.setpoint = autopilot::AngleHeadingRateThrust{0.1, 0.2, 0.3, 20.0};
  signals.command = autopilot::PassThroughCommand{{0.1, 0.2, 0.3}, 20.0};
  signals.sensors.gnss.emplace();
  return signals;
}

template <class T>
void encode(benchmark::State& state, const T& value) {
  ByteBuffer out(1 << 16);
  for (auto _ : state) {
    out.clear();
    encode_cdr(value, out);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(out.size()));
}

void EncodeTruth(benchmark::State& state) {
  encode(state, simulator::Truth{});
}
void EncodeEstimate(benchmark::State& state) {
  encode(state, autopilot::StateEstimate{});
}
void EncodeSignals(benchmark::State& state) {
  encode(state, flying_signals());
}

void Checksum(benchmark::State& state) {
  const std::vector<std::uint8_t> bytes(64 * 1024, 0x5A);
  for (auto _ : state) benchmark::DoNotOptimize(crc32(bytes));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}

/// What a second of flight computes, made beforehand so that only recording is timed. The numbers change as
/// in flight, so that compression has something to do.
struct Tick {
  simulator::Truth truth;
  autopilot::Signals signals;
};

std::vector<Tick> one_second() {
  std::vector<Tick> ticks(400);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double t = 0.0025 * static_cast<double>(i);
    auto& [truth, signals] = ticks[i];
    signals = flying_signals();
    truth.p_NB_N = {std::sin(t), std::cos(1.1 * t), -5.0 + 0.1 * std::sin(3.0 * t)};
    truth.v_NB_N = {std::cos(t), -std::sin(1.1 * t), 0.3 * std::cos(3.0 * t)};
    truth.f_B = {0.1 * std::sin(50.0 * t), 0.1 * std::cos(60.0 * t), -9.8};
    signals.estimate.p_NB_N = truth.p_NB_N + 0.1 * truth.f_B;
    signals.estimate.v_NB_B = truth.v_NB_N;
    signals.sensors.imu.f_B = truth.f_B;
    signals.trajectory.p_N = truth.p_NB_N;
  }
  return ticks;
}

/// One simulated second of a flight with 400 ticks: six signals and the truth, each at range(0) Hz.
void RecordOneSecond(benchmark::State& state, const McapOptions& options) {
  const std::vector<Tick> ticks = one_second();
  autopilot::Signals signals;
  simulator::Truth truth;
  Recorder recorder(log_file(), {.file = options, .topics = {}});
  const microseconds period(1000000 / state.range(0));
  recorder.add("/autopilot/sensors", signals.sensors, period);
  recorder.add("/autopilot/flight", signals.flight, period);
  recorder.add("/autopilot/estimate", signals.estimate, period);
  recorder.add("/autopilot/trajectory", signals.trajectory, period);
  recorder.add("/autopilot/setpoint", signals.setpoint, period);
  recorder.add("/autopilot/command", signals.command, period);
  recorder.add("/truth", truth, period);
  std::chrono::nanoseconds now{0};
  for (auto _ : state) {
    for (std::size_t i = 0; i < ticks.size(); ++i, now += microseconds(2500)) {
      // The route is left out: it is a vector, and copying it is not recording.
      truth = ticks[i].truth;
      signals.estimate = ticks[i].signals.estimate;
      signals.sensors.imu = ticks[i].signals.sensors.imu;
      signals.trajectory = ticks[i].signals.trajectory;
      recorder.observe(now);
    }
  }
  recorder.close();
  const auto bytes = static_cast<double>(recorder.file().file_size());
  const auto messages = static_cast<double>(recorder.file().message_count());
  const auto seconds = static_cast<double>(state.iterations());
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
  state.counters["messages_per_second"] = messages / seconds;
  state.counters["kB_per_second"] = 1e-3 * bytes / seconds;
  std::filesystem::remove(log_file());
}

BENCHMARK(EncodeTruth);
BENCHMARK(EncodeEstimate);
BENCHMARK(EncodeSignals);
BENCHMARK(Checksum);
// The number of iterations is fixed so that the file stays small: 2 000 simulated seconds.
BENCHMARK_CAPTURE(RecordOneSecond, Stored, McapOptions{})
    ->Arg(400)
    ->Arg(100)
    ->Arg(50)
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(RecordOneSecond, Compressed, McapOptions{.compress = true})
    ->Arg(400)
    ->Arg(100)
    ->Arg(50)
    ->Iterations(500)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(RecordOneSecond, Journal, McapOptions{.journal = true})
    ->Arg(400)
    ->Arg(100)
    ->Arg(50)
    ->Iterations(500)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ironbird::scenarios
