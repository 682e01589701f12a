#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <time.h>

#include <future>

#include "hil_bridge/can/esc_bus.hpp"
#include "hil_bridge/can/esc_controller.hpp"
#include "hil_bridge/transport/socket_can.hpp"
#include "hil_bridge/transport/test/foreign_tools.hpp"

// Motors on a real CAN stack, by the clock of the wall. How long things take there is nobody's promise: what
// is asked is that they come true. Runs under ci/with_vcan.

namespace ironbird::hil_bridge::transport {
namespace {

Time since(Time epoch) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + Time(now.tv_nsec) - epoch;
}

class EscOverSocketTest : public ::testing::Test {
 protected:
  Time now() const { return since(epoch_); }

  Time epoch_ = since(Time(0));
  SocketCan bench_end_{{.interface = "vcan0", .fd = true}, epoch_};
  // A machine under load must not let a command grow old between two looks.
  can::EscBus escs_{{.command_timeout = 1.0}, bench_end_, Time(0)};
  std::array<can::EscReading, 4> readings_{};
};

TEST_F(EscOverSocketTest, TurnsMotorsByTheFramesOfAForeignSender) {
  // Again and again, each time as another transfer: one that waits for a slow machine is too old.
  Tool cansend(
      "sh -c 'for k in 0 1 2 3 4 5 6 7 8 9 A B C D E F; do cansend vcan0 10044C0A#FFC$k; "
      "cansend vcan0 0804060A#E80F407B82E80FC$k; done'");
  EXPECT_TRUE(comes_true([&] {
    escs_.step(readings_, now());
    return escs_.commands()[3].throttle > 0.0;
  }));
  for (int motor = 0; motor < 4; ++motor) {
    EXPECT_DOUBLE_EQ(escs_.commands()[static_cast<std::size_t>(motor)].throttle,
                     1000.0 * (motor + 1) / 8191.0);
  }
  EXPECT_TRUE(comes_true([&] {
    escs_.step(readings_, now());
    return escs_.commands()[3].condition == can::EscCondition::kStale;
  })) << "and stops them when no more come";
}

TEST_F(EscOverSocketTest, TellsAForeignListenerWhoItIs) {
  while (bench_end_.receive()) {
  }
  Tool candump("candump -L -T 30000 -n 1 vcan0,18010A94:1FFFFFFF");
  Tool cansend("sh -c 'for k in 1 2 3 4 5 6 7 8; do cansend vcan0 1801948A#C$k; sleep 0.3; done'");
  std::future<std::vector<std::string>> heard =
      std::async(std::launch::async, [&] { return candump.lines(); });
  EXPECT_TRUE(comes_true([&] {
    escs_.step(readings_, now());
    return heard.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }));
  const std::vector<std::string> lines = heard.get();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], ::testing::ContainsRegex("18010A94#[0-9A-F]{14}8[1-8]$"));
}

TEST_F(EscOverSocketTest, ClosesTheLoopWithTheBenchAsController) {
  SocketCan other_end({.interface = "vcan0", .fd = true}, epoch_);
  can::EscController controller({}, other_end, Time(0));
  controller.set_armed(true);
  constexpr std::array kThrottles = {0.25, 0.5, 0.75, 1.0};
  for (std::size_t motor = 0; motor < 4; ++motor)
    readings_[motor].speed = 104.72 * static_cast<double>(motor + 1);
  const auto settled = [&] {
    controller.command(kThrottles, now());
    controller.step(now());
    escs_.step(readings_, now());
    bool all = true;
    for (std::size_t motor = 0; motor < 4; ++motor) {
      all = all && controller.motor_ready(motor, now()) && escs_.commands()[motor].throttle > 0.0 &&
            controller.node(static_cast<std::uint8_t>(20 + motor)).named;
    }
    return all;
  };
  ASSERT_TRUE(comes_true(settled));
  for (std::size_t motor = 0; motor < 4; ++motor) {
    EXPECT_NEAR(escs_.commands()[motor].throttle, kThrottles[motor], 1.0 / 8191);
    EXPECT_EQ(controller.motor(motor).status.rpm, 1000 * static_cast<int>(motor + 1));
  }
  controller.set_armed(false);
  EXPECT_TRUE(comes_true([&] {
    settled();
    return escs_.commands()[0].throttle == 0.0;
  }));
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
