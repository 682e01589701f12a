#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hil_bridge/virtual_fcu/battery_monitor.hpp"
#include "hil_bridge/virtual_fcu/mixer.hpp"
#include "hil_bridge/virtual_fcu/test/fake_board.hpp"

// Numbers that are none, from every side that can bring them: the board's outputs stay finite.

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

using namespace rosflight;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNotNumbers[] = {kNan, kInfinity, -kInfinity};

bool all_finite(const std::array<float, kOutputs>& outputs) {
  return std::all_of(outputs.begin(), outputs.end(), [](float output) { return std::isfinite(output); });
}

/// Armed, in full authority of the companion, with a servo on pin 5 and every attitude loop integrating.
class NotANumberTest : public ::testing::Test {
 protected:
  NotANumberTest()
      : fcu(armable({{"PID_ROLL_ANG_I", 0.1}, {"PID_ROLL_RATE_I", 0.1}, {"PID_YAW_RATE_D", 0.01}})) {
    fcu.rc_pass();
    fcu.imu_passes(2);
    fcu.arm();
    command(2, 0.1F);
  }
  void command(std::uint8_t mode, float roll) {
    fcu.deliver(OffboardControl{.u = {0, 0, mode == 0 ? -0.5F : 0.5F, roll}, .ignore = 0, .mode = mode});
    fcu.rc_pass();
    fcu.imu_pass();
  }

  FakeBoard fcu;
};

TEST_F(NotANumberTest, StopsTheMotorsThatACommandReachesAndComesBackWithTheNextInPassThrough) {
  for (const float bad : kNotNumbers) {
    command(0, bad);
    for (std::size_t pin = 0; pin < 4; ++pin) EXPECT_EQ(fcu.board().outputs[pin], 0.0F) << bad;
    command(0, 0.0F);
    for (std::size_t pin = 0; pin < 4; ++pin) EXPECT_NEAR(fcu.board().outputs[pin], 0.5F, 1e-5F) << bad;
  }
}

TEST_F(NotANumberTest, KeepsTheOutputsFiniteInEveryModeAndChannel) {
  for (const float bad : kNotNumbers) {
    for (std::uint8_t mode = 0; mode < 3; ++mode) {
      for (std::size_t channel = 0; channel < 10; ++channel) {
        OffboardControl control{.u = {0, 0, 0.5F}, .ignore = 0, .mode = mode};
        control.u[channel] = bad;
        fcu.deliver(control);
        fcu.rc_pass();
        fcu.imu_pass();
        ASSERT_TRUE(all_finite(fcu.board().outputs)) << bad << " in mode " << int{mode} << " at " << channel;
      }
    }
  }
}

TEST_F(NotANumberTest, KeepsTheOutputsFiniteWhateverRealParameterIsSet) {
  for (std::uint16_t k = 0; k < kParameterCount; ++k) {
    if (kParameterTable[k].type != ParameterType::kReal) continue;
    for (const float bad : kNotNumbers) {
      const std::uint32_t before = fcu.firmware().parameters().bits({k});
      fcu.deliver(ParamSet{{bits_of(bad)}, 1, 0, kParameterTable[k].name, 9});
      fcu.rc_pass();
      fcu.imu_passes(2);
      ASSERT_TRUE(all_finite(fcu.board().outputs)) << kParameterTable[k].name.data();
      fcu.deliver(ParamSet{{before}, 1, 0, kParameterTable[k].name, 9});
    }
  }
}

TEST_F(NotANumberTest, StopsAnAuxiliaryMotorAndLeavesAnAuxiliaryServoWhereItIs) {
  RosflightAuxCmd aux;
  aux.aux_cmd_array[11] = 0.6F;
  aux.type_array[11] = 1;
  aux.aux_cmd_array[12] = 0.7F;
  aux.type_array[12] = 2;
  fcu.deliver(aux);
  fcu.imu_pass();
  EXPECT_NEAR(fcu.board().outputs[11], 0.8F, 1e-6F);
  EXPECT_NEAR(fcu.board().outputs[12], 0.7F, 1e-6F);
  aux.aux_cmd_array[11] = aux.aux_cmd_array[12] = kNan;
  fcu.deliver(aux);
  fcu.imu_pass();
  EXPECT_NEAR(fcu.board().outputs[11], 0.8F, 1e-6F);
  EXPECT_EQ(fcu.board().outputs[12], 0.0F);
}

TEST_F(NotANumberTest, RefusesAnExternalAttitudeThatIsNone) {
  for (const float bad : {kNan, kInfinity, 1e20F, 2000.0F}) {
    for (int place = 0; place < 4; ++place) {
      fcu.deliver(ExternalAttitude{.qw = place == 0 ? bad : 1.0F,
                                   .qx = place == 1 ? bad : 0.0F,
                                   .qy = place == 2 ? bad : 0.0F,
                                   .qz = place == 3 ? bad : 0.0F});
      fcu.imu_pass();
      EXPECT_NEAR(fcu.firmware().filter().attitude().q_NB.w, 1.0F, 1e-6F) << bad << " at " << place;
    }
  }
}

TEST_F(NotANumberTest, KeepsAnExternalAttitudeThroughAStepOfNoLength) {
  fcu.imu_passes(1200);  // beyond FILT_INIT_T
  const auto repeat = [&](std::uint64_t stamp) {
    fcu.board().imu = ImuInput{.stamp_us = stamp, .acceleration = {0, 0, -kGravity}, .angular_velocity = {}};
    fcu.pass();
  };
  const std::uint64_t now = fcu.board().clock_us;
  fcu.deliver(ExternalAttitude{.qw = std::cos(0.1F), .qx = 0, .qy = 0, .qz = std::sin(0.1F)});
  repeat(now);
  EXPECT_EQ(fcu.firmware().filter().attitude().heading(), 0.0F);
  repeat(now + 2500);
  EXPECT_GT(fcu.firmware().filter().attitude().heading(), 0.0F);
  EXPECT_TRUE(all_finite(fcu.board().outputs));
}

TEST_F(NotANumberTest, FliesOnThroughAVerticalNose) {
  fcu.deliver(ParamSet{{bits_of(0)}, 1, 0, name_field("FILT_USE_ACC"), 6});
  for (int k = 0; k < 4000; ++k) {
    fcu.imu_pass({0, 0, -kGravity}, {0.0F, 3.0F + 1e-3F * static_cast<float>(k), 0.0F});
    ASSERT_TRUE(std::isfinite(fcu.firmware().filter().attitude().pitch())) << k;
    for (std::size_t pin = 0; pin < 4; ++pin) ASSERT_GT(fcu.board().outputs[pin], 0.0F) << k;
  }
}

TEST(BatteryMonitorTest, PassesOverAVoltageOrCurrentThatIsNone) {
  BatteryMonitor battery;
  battery.start(ParameterStore{});
  for (const float bad : kNotNumbers) {
    battery.add({bad, 8.0F});
    battery.add({20.0F, bad});
  }
  BatteryMonitor sound;
  sound.start(ParameterStore{});
  for (int k = 0; k < 3; ++k) sound.add({20.0F, 8.0F});
  EXPECT_EQ(battery.voltage(), sound.voltage());
  EXPECT_EQ(battery.current(), sound.current());
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
