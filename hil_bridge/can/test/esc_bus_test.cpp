#include "hil_bridge/can/esc_bus.hpp"

#include <gtest/gtest.h>

#include "hil_bridge/can/esc_controller.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge::can {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A flight controller at one end, four simulated motors behind one socket at the other.
class EscBusTest : public ::testing::TestWithParam<bool> {
 protected:
  void run(Time duration) {
    for (const Time end = now_ + duration; now_ < end;) {
      if (commanding_) fcu_.command(throttles_, now_);
      fcu_.step(now_);
      bus_.advance(now_ += milliseconds(2));
      escs_.step(readings_, now_);
    }
    fcu_.step(now_);
  }

  transport::InProcessBus bus_{{.fd = true}};
  transport::FrameBus& fcu_end_ = bus_.attach();
  transport::FrameBus& bench_end_ = bus_.attach();
  EscController fcu_{{.count = 4, .fd = GetParam()}, fcu_end_, Time(0)};
  EscBus escs_{{.fd = GetParam()}, bench_end_, Time(0)};
  std::array<double, 4> throttles_ = {0.1, 0.2, 0.3, 0.4};
  std::array<EscReading, 4> readings_{};
  Time now_{0};
  bool commanding_ = true;
};

INSTANTIATE_TEST_SUITE_P(Format, EscBusTest, ::testing::Values(false, true),
                         [](const auto& param) { return param.param ? "CanFd" : "Classic"; });

TEST_P(EscBusTest, TurnsTheCommandIntoThrottlesOfTheMotors) {
  fcu_.set_armed(true);
  run(milliseconds(20));
  for (std::size_t motor = 0; motor < 4; ++motor) {
    EXPECT_NEAR(escs_.commands()[motor].throttle, throttles_[motor], 1.0 / 8191);
  }
}

TEST_P(EscBusTest, ReportsEachMotorUnderItsOwnNode) {
  for (std::size_t motor = 0; motor < 4; ++motor)
    readings_[motor].speed = 104.72 * static_cast<double>(motor + 1);
  run(seconds(2));
  for (std::size_t motor = 0; motor < 4; ++motor) {
    EXPECT_EQ(fcu_.motor(motor).status.rpm, 1000 * static_cast<int>(motor + 1));
    EXPECT_EQ(fcu_.motor(motor).node, 20 + motor);
    EXPECT_TRUE(fcu_.motor_ready(motor, now_));
    EXPECT_TRUE(fcu_.node(static_cast<std::uint8_t>(20 + motor)).named);
  }
}

TEST_P(EscBusTest, StopsAllMotorsWhenCommandsStop) {
  fcu_.set_armed(true);
  run(seconds(1));
  commanding_ = false;
  run(milliseconds(90));
  EXPECT_GT(escs_.commands()[3].throttle, 0.0);
  run(milliseconds(14));
  for (const EscCommand& command : escs_.commands()) {
    EXPECT_EQ(command.throttle, 0.0);
    EXPECT_EQ(command.condition, EscCondition::kStale);
  }
}

TEST_P(EscBusTest, LosesNothingOnAFreeBus) {
  fcu_.set_armed(true);
  run(seconds(5));
  for (std::size_t motor = 0; motor < 4; ++motor) {
    const NodePort& port = escs_.node(motor).port();
    EXPECT_EQ(port.receiver().counters().corrupted, 0U);
    EXPECT_EQ(port.receiver().counters().abandoned, 0U);
    EXPECT_EQ(port.outbox().expired(), 0U);
    EXPECT_EQ(port.outbox().refused(), 0U);
  }
  EXPECT_EQ(bench_end_.counters().refused, 0U);
  EXPECT_EQ(bench_end_.counters().lost, 0U);
}

TEST_P(EscBusTest, StopsItsMotorsWhenItsControllerGoesOff) {
  fcu_.set_armed(true);
  run(seconds(1));
  bus_.corrupt_next(40);
  run(milliseconds(300));
  EXPECT_EQ(fcu_end_.state() == transport::BusState::kOff || bench_end_.state() == transport::BusState::kOff,
            true);
  for (const EscCommand& command : escs_.commands()) EXPECT_EQ(command.throttle, 0.0);
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
