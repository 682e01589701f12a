#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hil_bridge/virtual_fcu/motor_model.hpp"
#include "hil_bridge/virtual_fcu/test/fake_board.hpp"

// When a parameter that is changed over the link takes effect, parameter by parameter.

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

using namespace rosflight;

class ParameterEffectTest : public ::testing::Test {
 protected:
  ParameterEffectTest() : fcu(armable()) {
    fcu.deliver(Heartbeat{});
    for (int k = 0; k < 40; ++k) fcu.pass();
  }
  void set(std::string_view name, int value) {
    fcu.deliver(ParamSet{{bits_of(std::int32_t{value})}, 1, 0, name_field(name), 6});
  }
  void set(std::string_view name, float value) {
    fcu.deliver(ParamSet{{bits_of(value)}, 1, 0, name_field(name), 9});
  }
  /// Sets it to a value that it does not have.
  void change(std::string_view name) {
    const ParameterId id = find_parameter(name);
    ASSERT_LT(id.index, kParameterCount) << name;
    if (kParameterTable[id.index].type == ParameterType::kReal) {
      set(name, fcu.firmware().parameters().real(id) + 0.01F);
    } else {
      set(name, fcu.firmware().parameters().integer(id) + 1);
    }
  }
  float real(std::string_view name) const { return fcu.firmware().parameters().real(find_parameter(name)); }
  void fly() {
    fcu.rc_pass();
    fcu.imu_passes(2);
    fcu.arm();
    ASSERT_TRUE(fcu.firmware().arming().armed());
  }

  FakeBoard fcu;
};

TEST_F(ParameterEffectTest, RebuildsTheControllerWithTheDensityOfTheDayForTheseOnly) {
  struct Row {
    const char* name;
    bool rebuilds;
  };
  fcu.board().baro = PressureInput{80000.0F, 290.0F};
  fcu.pass();
  const float density = 1.225F * std::pow(80000.0F / 101325.0F, 0.8097369F);
  for (const Row row :
       {Row{"PID_ROLL_RATE_P", true},  Row{"PID_ROLL_RATE_I", true},  Row{"PID_ROLL_RATE_D", true},
        Row{"PID_PITCH_RATE_P", true}, Row{"PID_YAW_RATE_D", true},   Row{"PID_ROLL_ANG_P", true},
        Row{"PID_PITCH_ANG_P", true},  Row{"PID_PITCH_ANG_I", true},  Row{"PID_PITCH_ANG_D", true},
        Row{"PID_TAU", true},          Row{"MOTOR_RESISTANCE", true}, Row{"MOTOR_KV", true},
        Row{"NO_LOAD_CURRENT", true},  Row{"PROP_DIAMETER", true},    Row{"PROP_CT", true},
        Row{"BATT_VOLT_MAX", true},    Row{"NUM_MOTORS", true},       Row{"RC_MAX_THR", true},
        Row{"PROP_CQ", false},         Row{"X_EQ_TORQUE", false},     Row{"MOTOR_IDLE_THR", false},
        Row{"FAILSAFE_THR", false},    Row{"USE_MOTOR_PARAM", false}, Row{"BATT_VOLT_MULT", false},
        Row{"RC_MAX_ROLLRATE", false}}) {
    FakeBoard fresh(armable());
    fresh.board().baro = PressureInput{80000.0F, 290.0F};
    fresh.pass();
    const float boot = fresh.firmware().controller().maximum_thrust();
    const ParameterId id = find_parameter(row.name);
    const ParameterStore& parameters = fresh.firmware().parameters();
    const bool is_real = kParameterTable[id.index].type == ParameterType::kReal;
    const std::uint32_t bits =
        is_real ? bits_of(parameters.real(id) * 1.02F + 1e-4F) : bits_of(parameters.integer(id) + 1);
    fresh.deliver(
        ParamSet{{bits}, 1, 0, kParameterTable[id.index].name, is_real ? std::uint8_t{9} : std::uint8_t{6}});
    ASSERT_EQ(parameters.bits(id), bits) << row.name;
    const float wanted = row.rebuilds ? maximum_thrust(parameters, density) : boot;
    EXPECT_NEAR(fresh.firmware().controller().maximum_thrust(), wanted, 1e-3F) << row.name;
    EXPECT_GT(std::fabs(maximum_thrust(parameters, density) - boot), 1.0F) << "or the row shows nothing";
  }
}

TEST_F(ParameterEffectTest, RebuildsTheMixerForTheseOnly) {
  struct Row {
    const char* name;
    int value;
    bool rebuilds;
  };
  for (const Row row :
       {Row{"PRIMARY_MIXER", 1, true}, Row{"SECONDARY_MIXER", 1, true}, Row{"USE_MOTOR_PARAM", 1, true},
        Row{"RC_F_AXIS", 1, true}, Row{"NUM_MOTORS", 6, false}, Row{"FIXED_WING", 1, false},
        Row{"REV_RUDDER", 1, false}, Row{"ARM_SPIN_MOTORS", 0, false}, Row{"PRI_MIXER_OUT_6", 2, false}}) {
    FakeBoard fresh(armable());
    fresh.deliver(ParamSet{{bits_of(-0.3F)}, 1, 0, name_field("PRI_MIXER_2_0"), 9});
    fresh.deliver(ParamSet{{bits_of(row.value)}, 1, 0, name_field(row.name), 6});
    const ParameterStore& parameters = fresh.firmware().parameters();
    ASSERT_EQ(parameters.integer(find_parameter(row.name)), row.value);
    const bool edited = parameters.real(primary_element(2, 0)) == -0.3F;
    EXPECT_EQ(edited, !row.rebuilds) << row.name << ": a rebuilt canned mixer is written anew";
  }
}

TEST_F(ParameterEffectTest, AppliesOneElementAndOnePinAtOnce) {
  set("ARM_SPIN_MOTORS", 0);
  fly();
  fcu.deliver(OffboardControl{.u = {0, 0, -0.5F, 0, 0, 0, 0, 0, 0.5F}, .ignore = 0, .mode = 0});
  fcu.rc_pass();
  set("SEC_MIXER_2_1", -0.4F);
  set("PRI_MIXER_8_6", 0.4F);
  set("PRI_MIXER_OUT_6", 2);
  fcu.imu_pass();
  EXPECT_NEAR(fcu.board().outputs[0], 0.5F, 1e-5F);
  EXPECT_NEAR(fcu.board().outputs[1], 0.2F, 1e-6F);
  EXPECT_NEAR(fcu.board().outputs[6], 0.2F, 1e-6F);
  set("MOTOR_IDLE_THR", 0.25F);
  set("ARM_SPIN_MOTORS", 1);
  fcu.imu_pass();
  EXPECT_EQ(fcu.board().outputs[1], 0.25F);
}

TEST_F(ParameterEffectTest, OnlyStoresAPwmRate) {
  set("PRI_MIXER_PWM_0", 300.0F);
  EXPECT_EQ(real("PRI_MIXER_PWM_0"), 300.0F);
  set("USE_MOTOR_PARAM", 1);
  EXPECT_EQ(real("PRI_MIXER_PWM_0"), 490.0F) << "a rebuilt canned mixer brings its own";
}

TEST_F(ParameterEffectTest, MapsTheSwitchesAnewForTheseOnly) {
  struct Row {
    const char* name;
    bool maps;
  };
  for (const Row row :
       {Row{"RC_ATT_OVRD_CHN", true}, Row{"RC_THR_OVRD_CHN", true}, Row{"RC_ATT_CTRL_CHN", true},
        Row{"RC_ARM_CHN", true}, Row{"SWITCH_5_DIR", true}, Row{"SWITCH_6_DIR", true},
        Row{"SWITCH_7_DIR", true}, Row{"SWITCH_8_DIR", true}, Row{"RC_NUM_CHN", false},
        Row{"RC_X_CHN", false}, Row{"RC_F_CHN", false}, Row{"RC_OVRD_DEV", false}}) {
    const int before = fcu.texts("switch");
    change(row.name);
    EXPECT_EQ(fcu.texts("switch") - before, row.maps ? 4 : 0) << row.name << ": one line per switch";
  }
}

TEST_F(ParameterEffectTest, TurnsASwitchRoundAtOnce) {
  fcu.rc_pass();
  EXPECT_FALSE(fcu.firmware().rc().on(Switch::kAttitudeOverride));
  set("SWITCH_6_DIR", -1);
  fcu.rc_pass();
  EXPECT_TRUE(fcu.firmware().rc().on(Switch::kAttitudeOverride));
  EXPECT_FALSE(fcu.firmware().rc().on(Switch::kThrottleOverride));
}

TEST_F(ParameterEffectTest, RebuildsTheFailsafeCommandForTheseOnly) {
  fly();
  fcu.frame().failsafe = true;
  const auto value = [&](std::size_t axis) {
    fcu.rc_pass();
    return fcu.firmware().commands().combined().u[axis].value;
  };
  EXPECT_EQ(value(kForceZ), 0.3F);
  set("RC_F_AXIS", 0);
  EXPECT_EQ(value(kForceZ), 0.3F) << "not with its axis";
  EXPECT_EQ(value(kForceX), 0.0F);
  set("FAILSAFE_THR", 0.4F);
  EXPECT_EQ(value(kForceZ), 0.0F);
  EXPECT_EQ(value(kForceX), 0.4F);
  set("FIXED_WING", 1);
  EXPECT_EQ(value(kForceX), 0.0F);
  EXPECT_EQ(fcu.firmware().commands().combined().u[kRoll].kind, ChannelKind::kPassThrough);
}

TEST_F(ParameterEffectTest, JudgesTheFailsafeThrottleOfAMultirotorOnly) {
  set("FAILSAFE_THR", 1.5F);
  EXPECT_EQ(fcu.firmware().arming().errors(), kInvalidFailsafe);
  set("FIXED_WING", 1);
  EXPECT_EQ(fcu.firmware().arming().errors(), 0);
}

TEST_F(ParameterEffectTest, DoublesAsAWingOnTheLink) {
  set("FIXED_WING", 1);
  fcu.forget_sent();
  fcu.wait(1000000);
  fcu.pass();
  EXPECT_EQ(fcu.sent<Heartbeat>().at(0).type, 1);
  EXPECT_EQ(fcu.sent<RosflightStatus>().at(0).control_mode, 0);
}

TEST_F(ParameterEffectTest, AppliesTheseWithTheNextSample) {
  fly();
  set("X_EQ_TORQUE", 0.01F);
  set("Y_EQ_TORQUE", 0.02F);
  set("Z_EQ_TORQUE", 0.03F);
  set("IMU_ROLL", 180.0F);
  set("ACC_X_BIAS", 0.5F);
  fcu.deliver(OffboardControl{.u = {0, 0, -0.5F}, .ignore = 0, .mode = 0});
  fcu.rc_pass();
  fcu.imu_pass();
  EXPECT_EQ(fcu.firmware().mixer_inputs()[kRoll], 0.01F);
  EXPECT_EQ(fcu.firmware().mixer_inputs()[kPitch], 0.02F);
  EXPECT_EQ(fcu.firmware().mixer_inputs()[kYaw], 0.03F);
  EXPECT_NEAR(fcu.sent<SmallImu>().back().zacc, kGravity, 1e-5F);
  EXPECT_NEAR(fcu.sent<SmallImu>().back().xacc, -0.5F, 1e-5F);
}

TEST_F(ParameterEffectTest, AppliesBatteryFiltersOnlyWhenTheyChange) {
  const auto voltage = [&](float sample) {
    fcu.board().battery = BatteryInput{sample, sample};
    fcu.pass();
    return fcu.firmware().battery().voltage();
  };
  const float before = fcu.firmware().battery().voltage();
  EXPECT_NEAR(voltage(10.0F), 0.005F * 10.0F + 0.995F * before, 1e-4F);
  set("BATT_VOLT_LPF", 0.0F);
  EXPECT_EQ(voltage(10.0F), 10.0F);
  set("BATT_VOLT_MULT", 2.0F);
  EXPECT_EQ(voltage(10.0F), 20.0F);
  set("BATT_CURR_LPF", 0.0F);
  set("BATT_CURR_MULT", 3.0F);
  voltage(10.0F);
  EXPECT_EQ(fcu.firmware().battery().current(), 30.0F);
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
