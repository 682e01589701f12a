#include "hil_bridge/can/esc_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hil_bridge/can/esc_node.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge::can {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A controller and two ESCs, each with an end of its own.
class EscControllerTest : public ::testing::Test {
 protected:
  EscControllerTest() {
    for (int motor = 0; motor < 2; ++motor) {
      escs_.emplace_back(EscNodeParams{.node = 20 + motor, .esc_index = motor}, Time(0));
      ends_.push_back(&bus_.attach());
    }
  }

  void run(Time duration) {
    for (const Time end = now_ + duration; now_ < end;) {
      accepted_ = controller_.command(throttles_, now_);
      controller_.step(now_);
      for (std::size_t k = 0; k < escs_.size(); ++k) escs_[k].step(readings_[k], now_, *ends_[k]);
      bus_.advance(now_ += milliseconds(2));
      for (std::size_t k = 0; k < escs_.size(); ++k) {
        while (const auto frame = ends_[k]->receive()) escs_[k].take(*frame, now_);
      }
    }
    controller_.step(now_);
  }
  double throttle(std::size_t motor) const { return escs_[motor].command(now_).throttle; }
  bool ready(std::size_t motor) const { return controller_.motor_ready(motor, now_); }

  transport::InProcessBus bus_;
  transport::FrameBus& end_ = bus_.attach();
  EscController controller_{{.count = 2}, end_, Time(0)};
  std::vector<EscNode> escs_;
  std::vector<transport::FrameBus*> ends_;
  std::vector<double> throttles_ = {0.25, 0.75};
  std::array<EscReading, 3> readings_{};
  Time now_{0};
  bool accepted_ = false;
};

TEST_F(EscControllerTest, KeepsMotorsStillUntilItIsArmed) {
  run(seconds(1));
  EXPECT_EQ(throttle(0), 0.0);
  controller_.set_armed(true);
  run(milliseconds(10));
  EXPECT_NEAR(throttle(0), 0.25, 1.0 / 8191);
  EXPECT_NEAR(throttle(1), 0.75, 1.0 / 8191);
}

TEST_F(EscControllerTest, StopsMotorsWithinOneCommandOfDisarming) {
  controller_.set_armed(true);
  run(milliseconds(20));
  controller_.set_armed(false);
  run(milliseconds(2));
  EXPECT_EQ(throttle(0), 0.0);
}

TEST_F(EscControllerTest, SendsZerosInsteadOfACommandThatIsNone) {
  controller_.set_armed(true);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& bad : std::vector<std::vector<double>>{
           {0.5, nan}, {0.5, INFINITY}, {0.5, 1.001}, {-0.001, 0.5}, {0.5}, {0.5, 0.5, 0.5}, {}}) {
    throttles_ = {0.5, 0.5};
    run(milliseconds(10));
    EXPECT_TRUE(accepted_);
    EXPECT_GT(throttle(0), 0.0);
    throttles_ = bad;
    run(milliseconds(4));
    EXPECT_FALSE(accepted_);
    EXPECT_EQ(throttle(0), 0.0);
    EXPECT_EQ(throttle(1), 0.0);
  }
}

TEST_F(EscControllerTest, KnowsWhatTheMotorsReport) {
  readings_[1] = {.speed = 1047.2, .voltage = 22.0, .current = 3.5, .temperature = 310.0};
  run(milliseconds(100));
  EXPECT_EQ(controller_.motor(1).status.rpm, 10000);
  EXPECT_EQ(controller_.motor(1).status.voltage, 22.0F);
  EXPECT_EQ(controller_.motor(1).node, 21);
  EXPECT_TRUE(ready(0));
  EXPECT_TRUE(ready(1));
}

TEST_F(EscControllerTest, AsksEveryNodeForItsName) {
  run(milliseconds(300));
  EXPECT_TRUE(controller_.node(20).named);
  EXPECT_EQ(controller_.node(21).name.text(), "org.ironbird.esc");
  EXPECT_FALSE(controller_.node(22).named);
}

TEST_F(EscControllerTest, AsksAgainWhenTheAnswerWasLost) {
  while (!controller_.node_alive(20, now_)) run(milliseconds(2));
  // The question is out, and nobody hears it.
  bus_.plug(*ends_[0], false);
  run(milliseconds(500));
  bus_.plug(*ends_[0], true);
  run(milliseconds(400));
  EXPECT_FALSE(controller_.node(20).named);
  run(milliseconds(200));
  EXPECT_TRUE(controller_.node(20).named);
}

TEST_F(EscControllerTest, MissesAMotorAfter1200MillisecondsAndItsNodeAfterThreeSeconds) {
  run(seconds(2));
  bus_.plug(*ends_[0], false);
  run(milliseconds(1100));
  EXPECT_TRUE(ready(0));
  run(milliseconds(200));
  EXPECT_FALSE(ready(0));
  EXPECT_TRUE(ready(1));
  EXPECT_TRUE(controller_.node_alive(20, now_));
  run(milliseconds(2800));
  EXPECT_FALSE(controller_.node_alive(20, now_));
  bus_.plug(*ends_[0], true);
  run(milliseconds(1100));
  EXPECT_TRUE(ready(0));
}

TEST_F(EscControllerTest, NoticesARestartAndAsksWhoItIsNow) {
  run(seconds(3));
  escs_[0] = EscNode({.node = 20, .esc_index = 0, .name = "org.example.other"}, now_);
  run(seconds(1));
  EXPECT_EQ(controller_.node(20).restarts, 1U);
  EXPECT_EQ(controller_.node(21).restarts, 0U);
  run(milliseconds(100));
  EXPECT_EQ(controller_.node(20).name.text(), "org.example.other");
}

TEST_F(EscControllerTest, DoesNotTrustAMotorThatComplains) {
  run(seconds(2));
  readings_[0].health = kHealthError;
  run(milliseconds(1100));
  EXPECT_FALSE(ready(0));
  readings_[0].health = kHealthWarning;
  run(milliseconds(1100));
  EXPECT_TRUE(ready(0));
}

TEST_F(EscControllerTest, DoesNotTrustAMotorThatTwoNodesClaimToBe) {
  escs_.emplace_back(EscNodeParams{.node = 30, .esc_index = 1}, now_);
  ends_.push_back(&bus_.attach());
  run(milliseconds(500));
  EXPECT_TRUE(ready(0));
  EXPECT_FALSE(ready(1));
  bus_.plug(*ends_[2], false);
  run(milliseconds(2500));
  EXPECT_TRUE(ready(1)) << "the other one is gone";
}

TEST_F(EscControllerTest, LeavesMotorsToTheirTimeoutWhenItsBusIsOff) {
  controller_.set_armed(true);
  run(seconds(1));
  EXPECT_GT(throttle(0), 0.0);
  bus_.plug(end_, false);
  run(milliseconds(104));
  EXPECT_EQ(throttle(0), 0.0);
  EXPECT_EQ(escs_[0].command(now_).condition, EscCondition::kStale);
  bus_.plug(end_, true);
  run(milliseconds(200));
  EXPECT_GT(throttle(0), 0.0);
}

TEST_F(EscControllerTest, HoldsItsLoopOverANoisyBus) {
  transport::InProcessBus noisy({.corruption = 0.05, .loss = 0.02, .seed = 7});
  transport::FrameBus& here = noisy.attach();
  transport::FrameBus& there = noisy.attach();
  EscController controller({.count = 1}, here, Time(0));
  EscNode esc({.node = 20, .esc_index = 0}, Time(0));
  controller.set_armed(true);
  int stopped = 0;
  for (Time now{0}; now < seconds(20); now += milliseconds(2)) {
    controller.command(std::array{0.5}, now);
    controller.step(now);
    esc.step({}, now, there);
    noisy.advance(now + milliseconds(2));
    while (const auto frame = there.receive()) esc.take(*frame, now + milliseconds(2));
    stopped += now > seconds(1) && esc.command(now + milliseconds(2)).throttle == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(stopped, 0) << "fifty commands in a row are not lost by chance";
  EXPECT_TRUE(controller.motor_ready(0, seconds(20)));
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
