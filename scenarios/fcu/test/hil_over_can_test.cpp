// Hardware in the loop as far as it goes without a board: a unit in a process of its own, on a serial line
// and a real CAN bus, flies the vehicle that is simulated here. Runs under ci/with_vcan, where the clock of
// both runs slowly: an emulated machine is slow.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/lockstep.hpp"
#include "hil_bridge/interlock/gate.hpp"
#include "scenarios/bench/ground_watch.hpp"
#include "scenarios/bench/hil_rig.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/bench/world_maker.hpp"

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTimeScale = "0.2";
constexpr const char* kInterface = "vcan0";

const std::string kScenario = IRONBIRD_SOURCE_DIR "/scenarios/library/missions/take_off_and_land.toml";

/// The unit, in a process of its own, for as long as this lives.
class Unit {
 public:
  explicit Unit(const std::string& link, const char* more = "--on-desk") {
    process_ = fork();
    if (process_ == 0) {
      execl(IRONBIRD_PROGRAM, "ironbird", "fcu", "serve", kScenario.c_str(), "--pty", link.c_str(), "--can",
            kInterface, more, "--time-scale", kTimeScale, nullptr);
      _exit(127);
    }
    for (int k = 0; k < 3000 && !fs::exists(link); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ~Unit() {
    kill(process_, SIGINT);
    int status = 0;
    waitpid(process_, &status, 0);
  }

 private:
  pid_t process_ = -1;
};

LoadedScenario scenario_over(const std::string& link, const autopilot::Modules& modules) {
  LoadedScenario loaded = load_scenario(kScenario, {}, modules);
  FcuConfig& fcu = loaded.scenario.fcu;
  fcu.kind = FcuKind::kHil;
  fcu.line = link;
  fcu.motors = std::string(kCanInterface) + kInterface;
  fcu.time_scale = std::stod(kTimeScale);
  return loaded;
}

std::unique_ptr<autopilot::Autopilot> autopilot_of(const LoadedScenario& loaded,
                                                   const autopilot::Modules& modules) {
  auto pilot = std::make_unique<autopilot::Autopilot>(loaded.autopilot, modules);
  autopilot::for_each_slot([&](const auto& slot) {
    const ModuleSettings* settings =
        loaded.settings_of(std::string(slot.name), (loaded.autopilot.*slot.config).kind);
    if (settings != nullptr) pilot->parameters().set_all(settings->values);
  });
  return pilot;
}

/// What a command says, on both streams, and how it ends.
std::pair<int, std::string> outcome_of(const std::string& command) {
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) text += static_cast<char>(c);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}

std::string empty_folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder.string();
}

TEST(HilOverCanTest, RefusesAnInterfaceThatIsDownInOneLineThatHelps) {
  ASSERT_EQ(std::system("PATH=$PATH:/usr/sbin:/sbin ip link set vcan1 down"), 0);
  std::string command = IRONBIRD_PROGRAM " fcu serve --can vcan1 --pty ";
  command.append(empty_folder("ironbird_can_down")).append("/unit ").append(kScenario);
  const auto [code, text] = outcome_of(command);
  EXPECT_EQ(code, 3);
  EXPECT_EQ(text, "CAN interface vcan1: is down. Switch it on: ip link set vcan1 up\n");
}

TEST(HilOverCanTest, CommandsItsMotorsInFramesThatAForeignListenerCounts) {
  for (const char* more : {"--on-desk", "--can-fd"}) {
    const Unit unit(empty_folder("ironbird_can_heard").append("/unit"), more);
    // RawCommand of node 10, as a classic frame or one of CAN FD; nobody has armed: zeros.
    const auto [code, text] = outcome_of("candump -L -T 60000 -n 20 vcan0,0704060A:1FFFFFFF");
    EXPECT_EQ(code, 0);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 20) << text;
    const bool fd = std::string_view(more) == "--can-fd";
    EXPECT_THAT(text, testing::HasSubstr(fd ? "0704060A##" : "0704060A#00000000000000"));
  }
}

TEST(HilOverCanTest, TakesOffHoldsAndLandsByAUnitOfItsOwnWithMotorsOnARealBus) {
  const std::string link = empty_folder("ironbird_hil_over_can").append("/unit");
  const Unit unit(link);
  const autopilot::Modules modules = autopilot::standard_modules();
  const LoadedScenario loaded = scenario_over(link, modules);
  const std::unique_ptr<simulator::World> world = make_world(loaded.scenario);
  const std::unique_ptr<HilRig> rig = make_hil_rig(loaded.scenario, *world, false);
  // The propellers of the unit over there are numbers too.
  hil_bridge::SimulatedUnitGate gate;
  rig->set_gate(gate);
  const auto pilot = autopilot_of(loaded, modules);
  hil_bridge::Lockstep loop(rig->fcu(), *pilot, loaded.scenario.fcu.tick);

  bool took_off = false;
  bool asked_to_land = false;
  double highest = 0.0;
  std::optional<double> held_since;
  GroundWatch ground;
  std::string touched;
  const auto began = std::chrono::steady_clock::now();
  while (to_seconds(loop.now()) < loaded.scenario.duration && touched.empty()) {
    const double now = to_seconds(loop.tick());
    if (!took_off && now >= 5.0) took_off = pilot->request(autopilot::TakeOff{}).accepted;
    const autopilot::FlightPhase phase = pilot->signals().flight.phase;
    if (phase == autopilot::FlightPhase::kHold && !held_since) held_since = now;
    if (held_since && !asked_to_land && now > *held_since + 4.0)
      asked_to_land = pilot->request(autopilot::Land{}).accepted;
    highest = std::max(highest, -world->truth().p_NB_N.z());
    const auto seen = ground.observe(world->truth());
    if (seen && *seen != std::string_view("lifted_off")) touched = *seen;
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::printf("%.1f s flown in %.1f s; %llu frames taken, %llu given; fell behind by %.3f s\n",
              to_seconds(loop.now()), wall,
              static_cast<unsigned long long>(rig->motors()->status().frames.received),
              static_cast<unsigned long long>(rig->motors()->status().frames.sent), to_seconds(rig->lost()));
  EXPECT_TRUE(took_off);
  EXPECT_TRUE(held_since.has_value());
  EXPECT_TRUE(asked_to_land);
  EXPECT_GT(highest, 1.5);  // the take-off goes to two metres
  EXPECT_EQ(touched, "landed");
  EXPECT_LT(world->truth().p_NB_N.head<2>().norm(), 1.5);
  EXPECT_EQ(rig->motors()->status().state, hil_bridge::transport::BusState::kActive);
  EXPECT_EQ(rig->motors()->status().frames.lost, 0U);
  EXPECT_EQ(rig->serial().connection().state(), hil_bridge::ConnectionState::kReady);
}

}  // namespace
}  // namespace ironbird::scenarios
