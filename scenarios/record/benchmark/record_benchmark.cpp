#include <benchmark/benchmark.h>

#include <filesystem>

#include "autopilot/signals.hpp"
#include "ci/yardstick/in_turns.hpp"
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
  yardstick::beside_rk4(state, 0.0, [&] {
    out.clear();
    encode_cdr(value, out);
    benchmark::DoNotOptimize(out.data());
  });
}

void EncodeTruthBesideRk4(benchmark::State& state) {
  encode(state, simulator::Truth{});
}
void EncodeEstimateBesideRk4(benchmark::State& state) {
  encode(state, autopilot::StateEstimate{});
}
void EncodeSignalsBesideRk4(benchmark::State& state) {
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

/// A recorder of six signals and the truth, each at `rate`.
class Recording {
 public:
  Recording(const McapOptions& options, std::int64_t rate)
      : recorder_(log_file(), {.file = options, .topics = {}}) {
    const microseconds period(1000000 / rate);
    recorder_.add("/autopilot/sensors", signals_.sensors, period);
    recorder_.add("/autopilot/flight", signals_.flight, period);
    recorder_.add("/autopilot/estimate", signals_.estimate, period);
    recorder_.add("/autopilot/trajectory", signals_.trajectory, period);
    recorder_.add("/autopilot/setpoint", signals_.setpoint, period);
    recorder_.add("/autopilot/command", signals_.command, period);
    recorder_.add("/truth", truth_, period);
  }
  ~Recording() {
    recorder_.close();
    std::filesystem::remove(log_file());
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// One simulated second: 400 ticks.
  void record_one_second() {
    for (const Tick& tick : ticks_) {
      // The route is left out: it is a vector, and copying it is not recording.
      truth_ = tick.truth;
      signals_.estimate = tick.signals.estimate;
      signals_.sensors.imu = tick.signals.sensors.imu;
      signals_.trajectory = tick.signals.trajectory;
      recorder_.observe(now_);
      now_ += microseconds(2500);
    }
  }

  const McapWriter& file() const { return recorder_.file(); }

 private:
  std::vector<Tick> ticks_ = one_second();
  autopilot::Signals signals_;
  simulator::Truth truth_;
  Recorder recorder_;
  std::chrono::nanoseconds now_{0};
};

/// A tick's worth of log beside a step of the hand-written integrator, written to the disk.
void RecordBesideRk4(benchmark::State& state, const McapOptions& options) {
  constexpr int kTicks = 400;
  Recording recording(options, state.range(0));
  yardstick::HandWrittenRk4 rk4;
  const auto step = [&] {
    for (int i = 0; i < kTicks; ++i) rk4.step(2.5e-3);
  };
  yardstick::in_turns(
      state, {.pieces = kTicks}, [&] { recording.record_one_second(); }, step, [] {});
  const auto seconds = static_cast<double>(state.iterations());
  state.counters["messages_per_second"] = static_cast<double>(recording.file().message_count()) / seconds;
  state.counters["kB_per_second"] = 1e-3 * static_cast<double>(recording.file().file_size()) / seconds;
}

BENCHMARK(EncodeTruthBesideRk4)->UseManualTime();
BENCHMARK(EncodeEstimateBesideRk4)->UseManualTime();
BENCHMARK(EncodeSignalsBesideRk4)->UseManualTime();
BENCHMARK(Checksum);
// The number of iterations is fixed so that the file stays small.
BENCHMARK_CAPTURE(RecordBesideRk4, Stored, McapOptions{})
    ->Arg(400)
    ->Arg(100)
    ->Iterations(1000)
    ->UseManualTime();
BENCHMARK_CAPTURE(RecordBesideRk4, Compressed, McapOptions{.compress = true})
    ->Arg(400)
    ->Arg(100)
    ->Iterations(300)
    ->UseManualTime();
BENCHMARK_CAPTURE(RecordBesideRk4, Journal, McapOptions{.journal = true})
    ->Arg(400)
    ->Arg(100)
    ->Iterations(300)
    ->UseManualTime();

}  // namespace
}  // namespace ironbird::scenarios
