// Hardware in the loop as far as it goes without a board: a unit in a process of its own, on a serial line
// and a real CAN bus, flies the vehicle that another process simulates. Runs under ci/with_vcan, where the
// clock of both runs slowly: an emulated machine is slow. Or the unit's outputs turn real motors on a stand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "hil_bridge/can/esc_bus.hpp"
#include "hil_bridge/transport/machine_clock.hpp"
#include "hil_bridge/transport/socket_can.hpp"

namespace {

namespace fs = std::filesystem;
namespace can = ironbird::hil_bridge::can;
using ironbird::hil_bridge::transport::machine_time;
using ironbird::hil_bridge::transport::SocketCan;

constexpr const char* kTimeScale = "0.15";
const std::string kScenario = IRONBIRD_SOURCE_DIR "/scenarios/library/missions/take_off_and_land.toml";

/// The unit, in a process of its own, for as long as this lives.
class Unit {
 public:
  explicit Unit(const std::string& link, const char* more = "--on-desk", const char* motors = "--can=vcan0") {
    process_ = fork();
    if (process_ == 0) {
      execl(IRONBIRD_PROGRAM, "ironbird", "fcu", "serve", kScenario.c_str(), "--pty", link.c_str(),
            "--time-scale", kTimeScale, more, motors, nullptr);
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

/// Four motor controllers on a stand, in a thread of their own, for as long as this lives.
class Stand {
 public:
  ~Stand() {
    ended_ = true;
    thread_.join();
  }
  double greatest_throttle() const { return greatest_; }
  double throttle() const { return throttle_; }
  /// What motor 0 was in when all last stopped.
  can::EscCondition stopped_in() const { return stopped_in_; }

 private:
  void turn() {
    SocketCan bus({.interface = "vcan0"}, machine_time());
    const auto start = machine_time();
    can::EscBus escs({.command_timeout = 1.0}, bus, {});  // an emulated machine is slow
    std::array<can::EscReading, 4> readings{};
    while (!ended_) {
      escs.step(readings, machine_time() - start);
      double greatest = 0.0;
      for (const can::EscCommand& command : escs.commands()) greatest = std::max(greatest, command.throttle);
      if (throttle_ > 0.0 && greatest == 0.0) stopped_in_ = escs.commands()[0].condition;
      throttle_ = greatest;
      greatest_ = std::max(greatest_.load(), greatest);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::atomic<bool> ended_ = false;
  std::atomic<double> greatest_ = 0.0;
  std::atomic<double> throttle_ = 0.0;
  std::atomic<can::EscCondition> stopped_in_ = can::EscCondition::kNeverCommanded;
  std::thread thread_{[this] { turn(); }};
};

// The flight is cut short in the air: what turns then gets its zeros.
TEST(HilOverCanTest, TurnsTheMotorsOfAStandWhileTheUnitFliesAndStopsThemAtTheEnd) {
  const std::string folder = empty_folder("ironbird_stand");
  const std::string link = std::string(folder).append("/unit");
  const Unit unit(link, "--on-desk", "--duration=1000");
  const Stand stand;
  std::string command = IRONBIRD_PROGRAM " run ";
  command.append(kScenario)
      .append(" --set fcu.kind=hil --set fcu.stand=can:vcan0 --set fcu.line=")
      .append(link);
  command.append(" --set fcu.time_scale=").append(kTimeScale);
  command.append(" --set duration='8 s' --no-report --release --out ").append(folder);
  const auto [code, text] = outcome_of(command);
  EXPECT_LE(code, 1) << text;
  EXPECT_GT(stand.greatest_throttle(), 0.3) << text;
  EXPECT_EQ(stand.throttle(), 0.0);
  EXPECT_THAT(stand.stopped_in(), testing::AnyOf(can::EscCondition::kDisarmed, can::EscCondition::kRunning))
      << "told to, not left alone";
  const auto [found, events] = outcome_of("grep -o 'motor [0-9] is ready' " + folder + "/*/verdict.json");
  EXPECT_EQ(std::count(events.begin(), events.end(), '\n'), 4) << text;
}

TEST(HilOverCanTest, TakesOffHoldsAndLandsByAUnitOfItsOwnWithMotorsOnARealBus) {
  const std::string folder = empty_folder("ironbird_hil_over_can");
  const std::string link = std::string(folder).append("/unit");
  const Unit unit(link);
  std::string command = IRONBIRD_PROGRAM " run ";
  command.append(kScenario)
      .append(" --set fcu.kind=hil --set fcu.motors=can:vcan0 --set fcu.line=")
      .append(link);
  command.append(" --set fcu.time_scale=").append(kTimeScale).append(" --no-report --out ").append(folder);
  const auto [unasked, refusal] = outcome_of(command);
  EXPECT_EQ(unasked, 2);
  EXPECT_THAT(refusal, testing::HasSubstr("--release")) << "without the operator's word";
  const auto [code, text] = outcome_of(command + " --release");
  EXPECT_EQ(code, 0) << text;
  EXPECT_THAT(text, testing::HasSubstr("take_off_and_land: pass"));
  std::printf("%s", text.c_str());
}

}  // namespace
