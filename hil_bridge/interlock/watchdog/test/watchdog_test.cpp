#include "hil_bridge/interlock/watchdog/watchdog.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "hil_bridge/interlock/watchdog/test/watched_unit.hpp"
#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "hil_bridge/transport/udp_socket.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::BenchProcess;
using test::kBenchsMotors;
using test::kIdleMotors;
using test::kPilotsMotors;
using test::WatchedUnit;
using testing::HasSubstr;
using transport::PseudoTerminal;
using transport::UdpSocket;

constexpr double kClose = 0.01;
// Within this the unit has to be out of the dead bench's hands. A machine that is busy with other things may
// take longer once; three times in a row it does not.
constexpr Time kGoal = milliseconds(150);
constexpr int kAttempts = 3;
constexpr Time kPatience = seconds(4);

struct Mishap {
  const char* name;
  int signal;
  const char* said;  // by the watchdog
  bool kills;        // the bench was still there
  Time detection{};  // longest time in which a guarded thread may be silent
};

std::string name_of_case(const testing::TestParamInfo<Mishap>& info) {
  return info.param.name;
}

class MishapTest : public testing::TestWithParam<Mishap> {
 protected:
  struct Outcome {
    Time reaction{};
    int thrusts_after = 0;
    int zeros_after = 0;
    std::string complaints;
  };

  /// The bench flies, the mishap happens, and then it is continued, should it still be there.
  Outcome let_it_happen(InterlockProfile profile, double motors_after) {
    PseudoTerminal terminal(testing::TempDir() + "ironbird_watchdog_" + GetParam().name);
    WatchedUnit unit(terminal);
    BenchProcess bench(terminal.name(), profile);
    unit.until(kPatience, [&] { return unit.motor() > kBenchsMotors - kClose; });
    EXPECT_NEAR(unit.motor(), kBenchsMotors, kClose) << "the bench never flew";
    bench.signal(GetParam().signal);
    Outcome outcome;
    outcome.reaction = unit.until(kPatience, [&] { return unit.motor() < kBenchsMotors - kClose; });
    unit.pass(milliseconds(50));
    EXPECT_NEAR(unit.motor(), motors_after, kClose);
    bench.signal(SIGCONT);
    const int thrusts = unit.line.thrusts;
    const int zeros = unit.line.zeros;
    unit.pass(milliseconds(500));
    outcome.thrusts_after = unit.line.thrusts - thrusts;
    outcome.zeros_after = unit.line.zeros - zeros;
    EXPECT_NEAR(unit.motor(), motors_after, kClose);
    EXPECT_EQ(bench.ended().value_or(0), SIGKILL) << "as waitpid says: ended by this signal";
    unit.pilot().arm(false);
    unit.until(kPatience, [&] { return !bench.watchdog_lives(); });
    EXPECT_FALSE(bench.watchdog_lives());
    EXPECT_EQ(unit.line.others, 0) << "nothing but motor commands of the bench, and zeros";
    outcome.complaints = bench.complaints();
    return outcome;
  }

  /// At least one of some attempts is as quick as it has to be; all are in order.
  void expect_in_time(InterlockProfile profile, double motors_after) {
    Time best = Time::max();
    for (int k = 0; k < kAttempts && best > kGoal + GetParam().detection; ++k) {
      const Outcome outcome = let_it_happen(profile, motors_after);
      EXPECT_EQ(outcome.thrusts_after, 0);
      if (profile == InterlockProfile::kBench) {
        EXPECT_GT(outcome.zeros_after, 20);
        EXPECT_THAT(outcome.complaints, HasSubstr("the unit says that it is disarmed"));
      } else {
        EXPECT_EQ(outcome.zeros_after, 0);
        EXPECT_THAT(outcome.complaints, HasSubstr("the pilot's radio has the vehicle"));
      }
      EXPECT_THAT(outcome.complaints, HasSubstr(GetParam().said));
      EXPECT_EQ(outcome.complaints.find("the bench was killed") != std::string::npos, GetParam().kills);
      best = std::min(best, outcome.reaction);
    }
    EXPECT_LE(best, kGoal + GetParam().detection);
    RecordProperty("reaction_ms", static_cast<int>(best.count() / 1'000'000));
    std::printf("%s: %.1f ms on the unit's clock\n", GetParam().name,
                static_cast<double>(best.count()) * 1e-6);
  }
};

TEST_P(MishapTest, EndsInZerosOnTheBench) {
  expect_in_time(InterlockProfile::kBench, kIdleMotors);
}
TEST_P(MishapTest, EndsInThePilotsHandsInTheAir) {
  expect_in_time(InterlockProfile::kFlight, kPilotsMotors);
}

// While only the operator's thread is stuck the control loop still commands: what is late then is Ctrl-C.
INSTANTIATE_TEST_SUITE_P(
    All, MishapTest,
    testing::Values(Mishap{"Stopped", SIGSTOP, "the control loop was silent for", true},
                    Mishap{"Killed", SIGKILL, "the bench has ended without taking leave", false},
                    Mishap{"ControlDeadlocks", SIGUSR1, "the control loop was silent for", true},
                    Mishap{"OtherThreadDeadlocks", SIGUSR2, "the operator's thread was silent for", true,
                           milliseconds(200)}),
    name_of_case);

class WatchdogTest : public testing::Test {
 protected:
  void fly(InterlockProfile profile) {
    bench_.emplace(terminal_.name(), profile);
    unit_.until(kPatience, [&] { return unit_.motor() > kBenchsMotors - kClose; });
    ASSERT_NEAR(unit_.motor(), kBenchsMotors, kClose);
  }

  PseudoTerminal terminal_{testing::TempDir() + "ironbird_" +
                           testing::UnitTest::GetInstance()->current_test_info()->name()};
  WatchedUnit unit_{terminal_};
  std::optional<BenchProcess> bench_;
};

TEST_F(WatchdogTest, LeavesABenchAloneThatBeats) {
  fly(InterlockProfile::kBench);
  unit_.pass(seconds(2));
  EXPECT_NEAR(unit_.motor(), kBenchsMotors, kClose);
  EXPECT_FALSE(bench_->ended());
  EXPECT_EQ(unit_.line.zeros, 0);
}

TEST_F(WatchdogTest, SaysNothingAfterACleanEnd) {
  fly(InterlockProfile::kBench);
  bench_->signal(SIGTERM);
  unit_.until(kPatience, [&] { return bench_->ended().has_value(); });
  EXPECT_EQ(bench_->ended(), 0);
  EXPECT_EQ(bench_->said(), "leave");
  unit_.pass(milliseconds(300));
  EXPECT_EQ(unit_.line.zeros, 0);
  EXPECT_EQ(bench_->complaints(), "");
  EXPECT_FALSE(bench_->watchdog_lives());
}

TEST_F(WatchdogTest, IsMissedByTheBenchAtOnce) {
  fly(InterlockProfile::kBench);
  kill(bench_->watchdog(), SIGKILL);
  const Time took = unit_.until(kPatience, [&] { return bench_->ended().has_value(); });
  EXPECT_EQ(bench_->said(), "the watchdog is gone");
  EXPECT_LT(took, seconds(1));
  unit_.until(kPatience, [&] { return unit_.motor() < kBenchsMotors - kClose; });
  EXPECT_NEAR(unit_.motor(), kPilotsMotors, kClose);
}

TEST_F(WatchdogTest, IsMissedByTheBenchWhenItIsStopped) {
  fly(InterlockProfile::kBench);
  kill(bench_->watchdog(), SIGSTOP);
  unit_.until(milliseconds(500), [&] { return unit_.motor() < kBenchsMotors - kClose; });
  EXPECT_NEAR(unit_.motor(), kPilotsMotors, kClose);
  unit_.until(kPatience, [&] { return bench_->ended().has_value(); });
  EXPECT_EQ(bench_->said(), "the watchdog is gone");
  EXPECT_FALSE(bench_->watchdog_lives());
}

TEST_F(WatchdogTest, IsNotReachedByWhatEndsTheBench) {
  fly(InterlockProfile::kBench);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGTTOU, SIGPIPE}) {
    kill(bench_->watchdog(), number);
  }
  unit_.pass(milliseconds(100));
  EXPECT_FALSE(bench_->ended());
  EXPECT_NE(getpgid(bench_->watchdog()), getpgid(0)) << "Ctrl-C goes to the group of the terminal";
}

TEST_F(WatchdogTest, LeavesTheUnitToThePilotWhenTheLineIsCut) {
  fly(InterlockProfile::kBench);
  terminal_.hang_up();
  const Time took = unit_.until(kPatience, [&] { return unit_.motor() < kBenchsMotors - kClose; });
  EXPECT_NEAR(unit_.motor(), kPilotsMotors, kClose);
  EXPECT_LE(took, kGoal);
  EXPECT_FALSE(bench_->ended());
}

TEST_F(WatchdogTest, SendsItsZerosOverTheLineThatCameBack) {
  fly(InterlockProfile::kBench);
  terminal_.hang_up();
  unit_.until(kPatience, [&] { return unit_.motor() < kBenchsMotors - kClose; });
  ASSERT_TRUE(terminal_.reopen());
  unit_.until(kPatience, [&] { return unit_.motor() > kBenchsMotors - kClose; });
  bench_->signal(SIGKILL);
  unit_.until(kPatience, [&] { return unit_.motor() < kBenchsMotors - kClose; });
  EXPECT_NEAR(unit_.motor(), kIdleMotors, kClose);
  EXPECT_GT(unit_.line.zeros, 0);
  unit_.pilot().arm(false);
  unit_.until(kPatience, [&] { return !bench_->watchdog_lives(); });
  EXPECT_THAT(bench_->complaints(), HasSubstr("without taking leave; sending zero thrust"));
}

TEST_F(WatchdogTest, SendsNothingForABenchWhoseGateIsClosed) {
  bench_.emplace(terminal_.name(), InterlockProfile::kBench, /*gate_open=*/false);
  unit_.pass(milliseconds(300));
  bench_->signal(SIGSTOP);
  unit_.until(kPatience, [&] { return !bench_->watchdog_lives(); });
  unit_.pass(milliseconds(100));
  EXPECT_TRUE(bench_->ended());
  EXPECT_EQ(unit_.line.zeros, 0);
  EXPECT_NEAR(unit_.motor(), kPilotsMotors, kClose);
  EXPECT_THAT(bench_->complaints(), HasSubstr("the gate was closed, nothing is sent"));
}

TEST_F(WatchdogTest, SaysThatAnArmedUnitIsLeftAfterTheLastZero) {
  fly(InterlockProfile::kBench);
  bench_->signal(SIGSTOP);
  unit_.until(seconds(5), [&] { return !bench_->watchdog_lives(); });
  EXPECT_THAT(bench_->complaints(), HasSubstr("has not said that it is disarmed: disarm it by radio"));
  unit_.until(kPatience, [&] { return unit_.motor() > kIdleMotors + kClose; });
  EXPECT_NEAR(unit_.motor(), kPilotsMotors, kClose);
}

// Ten seconds of zeros that reach nobody are ten seconds of the highest priority.
TEST_F(WatchdogTest, EndsWhenTheLineGoesBetweenItsZeros) {
  fly(InterlockProfile::kBench);
  bench_->signal(SIGKILL);
  unit_.until(kPatience, [&] { return unit_.line.zeros > 0; });
  ASSERT_GT(unit_.line.zeros, 0);
  terminal_.hang_up();
  const Time took = unit_.until(kPatience, [&] { return !bench_->watchdog_lives(); });
  EXPECT_LT(took, seconds(1)) << "guarded_bench asks for two seconds of zeros";
  EXPECT_THAT(bench_->complaints(), HasSubstr("the line to the unit is gone: disarm it by radio"));
}

class DatagramTest : public testing::Test {
 protected:
  void fly() {
    units_line_->open();
    unit_.emplace(*units_line_);
    bench_.emplace("udp:" + std::to_string(own_port_) + ":" + std::to_string(units_port_),
                   InterlockProfile::kBench);
    unit_->until(kPatience, [&] { return unit_->motor() > kBenchsMotors - kClose; });
    ASSERT_NEAR(unit_->motor(), kBenchsMotors, kClose);
  }

  // Ports that hardly another process has, below those that the machine hands out, and not the usual ones.
  const int own_port_ = 22000 + 2 * (getpid() % 5000);
  const int units_port_ = own_port_ + 1;
  std::optional<UdpSocket> units_line_{std::in_place,
                                       transport::UdpConfig{units_port_, "localhost", own_port_}};
  std::optional<WatchedUnit> unit_;
  std::optional<BenchProcess> bench_;
};

TEST_F(DatagramTest, ADeadBenchEndsInZerosUntilTheUnitIsDisarmed) {
  fly();
  bench_->signal(SIGKILL);
  const Time took = unit_->until(kPatience, [&] { return unit_->motor() < kBenchsMotors - kClose; });
  EXPECT_LE(took, kGoal);
  unit_->pass(milliseconds(300));
  EXPECT_NEAR(unit_->motor(), kIdleMotors, kClose);
  EXPECT_GT(unit_->line.zeros, 20);
  unit_->pilot().arm(false);
  unit_->until(kPatience, [&] { return !bench_->watchdog_lives(); });
  EXPECT_FALSE(bench_->watchdog_lives());
  EXPECT_EQ(unit_->line.others, 0);
  EXPECT_THAT(bench_->complaints(), HasSubstr("the unit says that it is disarmed"));
}

// Of datagrams nobody says that the other side is gone: the zeros go on for their time, and not without rest.
TEST_F(DatagramTest, SendsItsZerosWhenNobodyIsThereAndEnds) {
  fly();
  bench_->signal(SIGKILL);
  unit_->until(kPatience, [&] { return unit_->line.zeros > 0; });
  ASSERT_GT(unit_->line.zeros, 0);
  units_line_.reset();
  const auto began = std::chrono::steady_clock::now();
  std::optional<double> worked;
  while (bench_->watchdog_lives() && std::chrono::steady_clock::now() - began < kPatience) {
    if (const auto spent = bench_->watchdogs_cpu_seconds()) worked = std::max(worked.value_or(0.0), *spent);
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_FALSE(bench_->watchdog_lives());
  ASSERT_TRUE(worked) << "it could not be asked";
  EXPECT_LT(*worked, 0.2) << "of the two seconds of zeros that guarded_bench asks for";
  EXPECT_THAT(bench_->complaints(), HasSubstr("has not said that it is disarmed: disarm it by radio"));
}

TEST(WatchdogStartTest, RefusesToBeStartedBesideThreads) {
  std::thread other([] { std::this_thread::sleep_for(milliseconds(200)); });
  EXPECT_THROW(Watchdog(WatchdogConfig{}), std::runtime_error);
  other.join();
}

TEST(WatchdogStartTest, RefusesMoreThreadsThanItCanGuardAndLimitsThatAreNone) {
  WatchdogConfig config;
  config.threads.assign(Watchdog::kMostThreads + 1, {"a thread", milliseconds(1)});
  EXPECT_THROW(Watchdog{config}, std::runtime_error);
  config.threads = {{"a thread", Time::zero()}};
  EXPECT_THROW(Watchdog{config}, std::runtime_error);
}

}  // namespace
}  // namespace ironbird::hil_bridge
