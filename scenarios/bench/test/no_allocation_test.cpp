// In flight a tick without an event takes no memory from the heap and no lock, and no tick makes a system
// call; with a log there is one for each chunk. Counted over ten simulated seconds of the paper's mission:
// every call of malloc and of pthread_mutex_lock in this program, ours and the engines', and every system
// call, seen from a parent process.

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/syscall.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "autopilot/modules.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/bench/test/system_calls.hpp"
#include "simulator/plant/test/counted_malloc.hpp"

namespace {
std::atomic<long> locks_taken{0};
}  // namespace

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) {
  using Lock = int (*)(pthread_mutex_t*);
  static const Lock real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++locks_taken;
  return real(mutex);
}

namespace ironbird::scenarios {
namespace {

constexpr std::chrono::seconds kAirborne{20};
constexpr std::chrono::seconds kWatched{10};
constexpr int kTicks = 400 * kWatched.count();
/// Writing down that a waypoint was reached takes memory; it happens that often at the most.
constexpr int kMostEvents = 3;
constexpr std::uint64_t kChunkSize = McapOptions{}.chunk_size;

struct FlightCase {
  const char* name;
  const char* engine;
  const char* estimator;
  bool log;
};

class FlightCostTest : public ::testing::TestWithParam<FlightCase> {
 protected:
  FlightCostTest() {
    const Overrides overrides{
        {{"plant.engine", GetParam().engine}, {"autopilot.estimator.kind", GetParam().estimator}},
        std::nullopt};
    const std::string mission = IRONBIRD_SOURCE_DIR "/scenarios/library/paper/three_waypoints.toml";
    loaded_ = std::make_unique<LoadedScenario>(load_scenario(mission, overrides, modules_));
  }
  ~FlightCostTest() override { std::filesystem::remove(log_file()); }

  static std::filesystem::path log_file() {
    return std::filesystem::temp_directory_path() /
           (std::string("ironbird_cost_") + GetParam().name + ".mcap");
  }

  /// A bench whose vehicle is under way.
  std::unique_ptr<Bench> under_way() const {
    BenchOptions options;
    if (GetParam().log) options.log_file = log_file();
    auto bench = std::make_unique<Bench>(*loaded_, modules_, std::move(options));
    while (bench->tick() < kAirborne) {
    }
    return bench;
  }

 private:
  autopilot::Modules modules_ = autopilot::standard_modules();
  std::unique_ptr<LoadedScenario> loaded_;
};

TEST_P(FlightCostTest, TakesNoMemoryAndNoLock) {
  const std::unique_ptr<Bench> bench = under_way();
  int eventful = 0;
  for (int i = 0; i < kTicks; ++i) {
    const std::size_t events_before = bench->judge().events().size();
    const long memory_before = calls_of_malloc;
    const long locks_before = locks_taken;
    bench->tick();
    if (bench->judge().events().size() != events_before) {
      ++eventful;
      continue;
    }
    ASSERT_EQ(calls_of_malloc - memory_before, 0) << "in tick " << i;
    ASSERT_EQ(locks_taken - locks_before, 0) << "in tick " << i;
  }
  EXPECT_LE(eventful, kMostEvents);
  EXPECT_LT(bench->world().truth().p_NB_N.z(), -2.0) << "the vehicle was meant to fly";
}

TEST_P(FlightCostTest, MakesNoSystemCallButOneWriteForEachChunk) {
  const std::optional<SystemCalls> calls = system_calls_between_marks([&](const std::function<void()>& mark) {
    const std::unique_ptr<Bench> bench = under_way();
    mark();
    for (int i = 0; i < kTicks; ++i) bench->tick();
    mark();
  });
  if (!calls) GTEST_SKIP() << "this machine does not let a process watch its child";
  // The marks have returned the file's beginning too, so at most all chunks of thirty seconds.
  const std::uint64_t bytes = GetParam().log ? std::filesystem::file_size(log_file()) : 0;
  for (const auto& [number, count] : *calls) {
    EXPECT_EQ(number, SYS_writev);
    EXPECT_LE(count, bytes / kChunkSize);
  }
  EXPECT_EQ(calls->empty(), !GetParam().log);
}

TEST(FlightCostCounterTest, CountsWhatItIsMeantToCount) {
  const long memory_before = calls_of_malloc;
  const long locks_before = locks_taken;
  ::operator delete(::operator new(64));
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&mutex);
  pthread_mutex_unlock(&mutex);
  EXPECT_EQ(calls_of_malloc - memory_before, 1);
  EXPECT_EQ(locks_taken - locks_before, 1);
}

TEST(FlightCostCounterTest, SeesTheSystemCallsOfAChild) {
  const std::optional<SystemCalls> calls = system_calls_between_marks([](const std::function<void()>& mark) {
    syscall(SYS_getuid);
    mark();
    syscall(SYS_getgid);
    syscall(SYS_getgid);
    mark();
    syscall(SYS_getuid);
  });
  if (!calls) GTEST_SKIP() << "this machine does not let a process watch its child";
  EXPECT_EQ(*calls, (SystemCalls{{SYS_getgid, 2}}));
}

INSTANTIATE_TEST_SUITE_P(Flights, FlightCostTest,
                         ::testing::Values(FlightCase{"Mujoco", "mujoco", "ekf", false},
                                           FlightCase{"MujocoWithLog", "mujoco", "ekf", true},
                                           FlightCase{"OdeWithLog", "ode", "ekf", true},
                                           FlightCase{"ErrorStateFilter", "mujoco", "error_state", false}),
                         [](const auto& flight) { return flight.param.name; });

}  // namespace
}  // namespace ironbird::scenarios
