// What one tick of the whole closed loop costs beside a bare step of the engine at the same rate. The two
// take turns, one simulated second each; the promise is their ratio.

#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>

#include "autopilot/modules.hpp"
#include "ci/yardstick/bare_mujoco.hpp"
#include "ci/yardstick/in_turns.hpp"
#include "scenarios/app/reproducible_math.hpp"
#include "scenarios/bench/bench.hpp"

namespace ironbird::scenarios {
namespace {

constexpr const char* kMission = IRONBIRD_SOURCE_DIR "/scenarios/library/paper/three_waypoints.toml";
constexpr int kTicks = 400;        // of one simulated second
constexpr double kTickNs = 2.5e6;  // ns
constexpr std::chrono::seconds kAirborne{20};
constexpr std::chrono::seconds kHomeward{95};

/// The paper's mission between take-off and the way home, again and again.
class Mission {
 public:
  Mission(const Overrides& overrides, bool log)
      : loaded_(load_scenario(kMission, overrides, modules_)), log_(log) {}
  ~Mission() { std::filesystem::remove(log_file()); }

  void fly_one_second() {
    for (int i = 0; i < kTicks; ++i) now_ = bench_->tick();
  }

  /// Makes sure that the vehicle is under way.
  void prepare() {
    if (bench_ != nullptr && now_ < kHomeward) return;
    BenchOptions options;
    if (log_) options.log_file = log_file();
    bench_ = std::make_unique<Bench>(loaded_, modules_, std::move(options));
    do {
      now_ = bench_->tick();
    } while (now_ < kAirborne);
  }

 private:
  static std::filesystem::path log_file() {
    return std::filesystem::temp_directory_path() / "ironbird_loop_benchmark.mcap";
  }

  autopilot::Modules modules_ = autopilot::standard_modules();
  LoadedScenario loaded_;
  bool log_;
  std::unique_ptr<Bench> bench_;
  std::chrono::nanoseconds now_{0};
};

/// One tick of the loop beside a bare step.
void beside_bare(benchmark::State& state, double goal, const Overrides& overrides, bool log) {
  Mission mission(overrides, log);
  yardstick::BareMujoco bare;
  const auto step = [&] {
    for (int i = 0; i < kTicks; ++i) bare.step();
  };
  yardstick::in_turns(
      state, {.goal = goal, .pieces = kTicks}, [&] { mission.fly_one_second(); }, step,
      [&] { mission.prepare(); });
  state.counters["real_time"] = kTickNs / state.counters["ns"];
  state.SetLabel(reproducible_math());
}

void LoopWithLogBesideBareMujoco(benchmark::State& state) {
  beside_bare(state, 1.7, {}, true);
}
void LoopWithoutLogBesideBareMujoco(benchmark::State& state) {
  beside_bare(state, 0.0, {}, false);
}
void LoopOnOdeBesideBareMujoco(benchmark::State& state) {
  beside_bare(state, 0.0, {{{"plant.engine", "ode"}}, std::nullopt}, true);
}
void LoopWithErrorStateFilterBesideBareMujoco(benchmark::State& state) {
  beside_bare(state, 0.0, {{{"autopilot.estimator.kind", "error_state"}}, std::nullopt}, true);
}

/// The promise is that the log adds at most a tenth.
void LoopWithLogBesideLoopWithout(benchmark::State& state) {
  Mission logged({}, true);
  Mission silent({}, false);
  const auto prepare = [&] {
    logged.prepare();
    silent.prepare();
  };
  yardstick::in_turns(
      state, {.goal = 1.1, .pieces = kTicks}, [&] { logged.fly_one_second(); },
      [&] { silent.fly_one_second(); }, prepare);
}

BENCHMARK(LoopWithLogBesideBareMujoco)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LoopWithoutLogBesideBareMujoco)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LoopOnOdeBesideBareMujoco)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LoopWithErrorStateFilterBesideBareMujoco)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LoopWithLogBesideLoopWithout)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ironbird::scenarios
