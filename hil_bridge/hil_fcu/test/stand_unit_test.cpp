#include "hil_bridge/hil_fcu/stand_unit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "hil_bridge/can/esc_bus.hpp"
#include "hil_bridge/hil_fcu/test/puppet.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge {
namespace {

using test::kTick;
constexpr std::array kSpeeds = {100.0, 200.0, 300.0, 400.0};  // rad/s

/// A unit that tells its outputs 50 times a second, and four motor controllers on a stand.
class StandUnitTest : public testing::Test {
 protected:
  void run(int ticks) {
    for (int k = 0; k < ticks; ++k) {
      now_ += kTick;
      if (told_ && tick_++ % 8 == 0) unit_.says.emplace_back(*told_);
      stand_.advance(now_);
      heard_.clear();
      stand_.receive(heard_);
      if (stand_.motors() != nullptr) stand_.motors()->step(now_);
      all_heard_ += heard_.size();
      bus_.advance(now_ + kTick);
      for (std::size_t motor = 0; motor < kSpeeds.size(); ++motor) readings_[motor].speed = kSpeeds[motor];
      escs_.step(readings_, now_ + kTick);
    }
  }
  static rosflight::RosflightOutputRaw outputs(std::array<float, 4> throttles) {
    rosflight::RosflightOutputRaw raw;
    std::copy(throttles.begin(), throttles.end(), raw.values.begin());
    return raw;
  }
  double throttle(std::size_t motor) const { return escs_.commands()[motor].throttle; }

  transport::InProcessBus bus_;
  can::EscBus escs_{{}, bus_.attach(), Time{0}};
  test::Puppet unit_;
  StandUnit stand_{unit_, {}, bus_.attach()};
  InterlockStatus gate_;
  std::optional<rosflight::RosflightOutputRaw> told_ = outputs({0.2F, 0.4F, 0.6F, 0.8F});
  std::vector<Arrival> heard_;
  std::size_t all_heard_ = 0;

 private:
  std::array<can::EscReading, 4> readings_{};
  Time now_{};
  int tick_ = 0;
};

TEST_F(StandUnitTest, SaysNothingOnTheBusBeforeItIsOpen) {
  gate_.state = InterlockState::kLive;
  run(100);
  EXPECT_EQ(stand_.motors(), nullptr);
  EXPECT_EQ(escs_.commands()[0].condition, can::EscCondition::kNeverCommanded);
  EXPECT_EQ(all_heard_, 13U) << "what the unit says passes";
}

TEST_F(StandUnitTest, TurnsEachMotorAsTheUnitTells) {
  stand_.open(gate_);
  gate_.state = InterlockState::kReleased;
  run(40);
  EXPECT_EQ(throttle(3), 0.0);
  gate_.state = InterlockState::kLive;
  run(400);
  for (std::size_t motor = 0; motor < 4; ++motor) {
    EXPECT_NEAR(throttle(motor), 0.2 * static_cast<double>(motor + 1), 1e-4) << motor;
  }
  const StandStatus& status = stand_.motors()->status();
  EXPECT_TRUE(status.turning);
  for (std::size_t motor = 0; motor < 4; ++motor) {
    EXPECT_TRUE(status.motors[motor].ready) << motor;
    EXPECT_NEAR(status.motors[motor].speed, kSpeeds[motor], 0.1) << "told in whole revolutions per minute";
  }
  EXPECT_FALSE(status.motors[4].ready);
}

TEST_F(StandUnitTest, StopsThemWhenTheUnitTellsNothingMoreOrNonsense) {
  stand_.open(gate_);
  gate_.state = InterlockState::kLive;
  run(400);
  ASSERT_GT(throttle(0), 0.0);
  told_.reset();
  run(30);
  EXPECT_EQ(throttle(0), 0.0) << "75 ms without a word";
  told_ = outputs({0.2F, 0.2F, 0.2F, 0.2F});
  run(20);
  ASSERT_GT(throttle(0), 0.0);
  told_ = outputs({0.2F, 0.2F, std::numeric_limits<float>::quiet_NaN(), 0.2F});
  run(20);
  EXPECT_EQ(throttle(0), 0.0);
  EXPECT_FALSE(stand_.motors()->status().turning);
}

}  // namespace
}  // namespace ironbird::hil_bridge
