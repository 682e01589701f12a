// What one tick of the whole closed loop costs beside a bare step of the engine at the same rate. The two
// take turns, one simulated second each; the promise is their ratio.

#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "autopilot/modules.hpp"
#include "scenarios/app/reproducible_math.hpp"
#include "scenarios/bench/bench.hpp"

namespace ironbird::scenarios {
namespace {

constexpr const char* kMission = IRONBIRD_SOURCE_DIR "/scenarios/library/paper/three_waypoints.toml";
constexpr int kTicks = 400;  // of one simulated second
constexpr std::chrono::seconds kAirborne{20};
constexpr std::chrono::seconds kHomeward{95};

/// CPU time of this thread, s.
double cpu_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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

/// One body without shapes, every part of the engine off that a free body does not need.
class BareEngine {
 public:
  BareEngine() {
    constexpr const char* kModel = R"(<mujoco><option timestep="0.0025" integrator="RK4">
      <flag equality="disable" frictionloss="disable" limit="disable" constraint="disable" contact="disable"
       passive="disable" clampctrl="disable" sensor="disable"/></option>
      <worldbody><body><freejoint/><inertial pos="0 0 0" mass="3.9" diaginertia="0.0735 0.0733 0.125"/></body>
      </worldbody></mujoco>)";
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    const std::string_view text(kModel);
    mj_makeEmptyFileVFS(files.get(), "bare.xml", static_cast<int>(text.size()));
    std::copy(text.begin(), text.end(), static_cast<char*>(files->filedata[0]));
    char complaint[500] = "";
    model_ = mj_loadXML("bare.xml", files.get(), complaint, sizeof complaint);
    mj_deleteVFS(files.get());
    if (model_ == nullptr) throw std::runtime_error(complaint);
    data_ = mj_makeData(model_);
    data_->qvel[3] = 0.1;
  }
  ~BareEngine() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  BareEngine(const BareEngine&) = delete;
  BareEngine& operator=(const BareEngine&) = delete;

  void fly_one_second() {
    for (int i = 0; i < kTicks; ++i) mj_step(model_, data_);
  }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

void compare(benchmark::State& state, const Overrides& overrides, bool log) {
  Mission mission(overrides, log);
  BareEngine bare;
  double loop_time = 0.0;
  double bare_time = 0.0;
  for (auto _ : state) {
    mission.prepare();
    const double start = cpu_now();
    mission.fly_one_second();
    const double half = cpu_now();
    bare.fly_one_second();
    const double end = cpu_now();
    loop_time += half - start;
    bare_time += end - half;
    state.SetIterationTime(half - start);
  }
  const double ticks = kTicks * static_cast<double>(state.iterations());
  state.counters["tick_ns"] = 1e9 * loop_time / ticks;
  state.counters["bare_ns"] = 1e9 * bare_time / ticks;
  state.counters["ratio"] = loop_time / bare_time;
  state.counters["real_time"] = static_cast<double>(state.iterations()) / loop_time;
  state.SetLabel(reproducible_math());
}

void LoopWithoutLog(benchmark::State& state) {
  compare(state, {}, false);
}
void LoopWithLog(benchmark::State& state) {
  compare(state, {}, true);
}
void LoopOnOde(benchmark::State& state) {
  compare(state, {{{"plant.engine", "ode"}}, std::nullopt}, true);
}
void LoopWithErrorStateFilter(benchmark::State& state) {
  compare(state, {{{"autopilot.estimator.kind", "error_state"}}, std::nullopt}, true);
}

BENCHMARK(LoopWithoutLog)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LoopWithLog)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LoopOnOde)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(LoopWithErrorStateFilter)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ironbird::scenarios
