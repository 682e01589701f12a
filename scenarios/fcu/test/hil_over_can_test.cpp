// Hardware in the loop as far as it goes without a board: a unit in a process of its own, on a serial line
// and a real CAN bus, flies the vehicle that another process simulates. Runs under ci/with_vcan, where the
// clock of both runs slowly: an emulated machine is slow.

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

namespace {

namespace fs = std::filesystem;

constexpr const char* kTimeScale = "0.15";
const std::string kScenario = IRONBIRD_SOURCE_DIR "/scenarios/library/missions/take_off_and_land.toml";

/// The unit, in a process of its own, for as long as this lives.
class Unit {
 public:
  explicit Unit(const std::string& link, const char* more = "--on-desk") {
    process_ = fork();
    if (process_ == 0) {
      execl(IRONBIRD_PROGRAM, "ironbird", "fcu", "serve", kScenario.c_str(), "--pty", link.c_str(), "--can",
            "vcan0", more, "--time-scale", kTimeScale, nullptr);
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
