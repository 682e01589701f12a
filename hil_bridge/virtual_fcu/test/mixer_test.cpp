#include "hil_bridge/virtual_fcu/mixer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hil_bridge/virtual_fcu/command_mux.hpp"

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr float kRoundOff = 1e-6F;
constexpr float kSvd = 1e-5F;  // float32 singular-value decomposition of a 10 x 10 matrix
constexpr std::uint16_t kCompanion = 0;

/// Counts lines by severity.
class Lines : public TextLog {
 public:
  void write(Severity severity, std::string_view text) override { lines.emplace_back(severity, text); }
  int count(Severity severity) const {
    int n = 0;
    for (const auto& line : lines) n += line.first == severity ? 1 : 0;
    return n;
  }
  std::vector<std::pair<Severity, std::string>> lines;
};

class MixerTest : public ::testing::Test {
 protected:
  void choose(int primary, int secondary = 255) {
    parameters.set(parameter("PRIMARY_MIXER"), primary);
    parameters.set(parameter("SECONDARY_MIXER"), secondary);
    rebuild();
  }
  void rebuild() {
    mixer.configure(parameters);
    mixer.rebuild(parameters, log);
  }
  void mix(std::array<float, 10> u, MixerConditions conditions = {.armed = true, .overrides = kCompanion}) {
    conditions.battery_voltage = battery;
    mixer.mix(u, conditions, log);
  }
  float element(int i, int j) const { return parameters.real(primary_element(i, j)); }

  ParameterStore parameters;
  Mixer mixer;
  Lines log;
  float battery = 25.0F;
};

TEST_F(MixerTest, InvertsTheQuadX) {
  choose(2);
  constexpr float kQ = 0.35356F;
  const float roll[] = {-kQ, -kQ, kQ, kQ};
  const float pitch[] = {kQ, -kQ, -kQ, kQ};
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(element(2, j), -1.0F, kSvd);
    EXPECT_NEAR(element(3, j), roll[j], kSvd);
    EXPECT_NEAR(element(4, j), pitch[j], kSvd);
    EXPECT_NEAR(element(5, j), j % 2 == 0 ? 0.25F : -0.25F, kSvd);
    EXPECT_EQ(parameters.integer(parameter("PRI_MIXER_OUT_0") + j), 2);
    EXPECT_EQ(parameters.real(parameter("PRI_MIXER_PWM_0") + j), 490.0F);
  }
  EXPECT_EQ(element(0, 0), 0.0F);
  EXPECT_EQ(element(2, 4), 0.0F);
  EXPECT_EQ(parameters.integer(parameter("PRI_MIXER_OUT_4")), 0);
}

TEST_F(MixerTest, DrivesTheQuadXAsMeasured) {
  choose(2);
  mix({0, 0, -0.5F});
  for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(mixer.outputs()[j], 0.5F, kSvd);
  mix({0, 0, -0.5F, 0, 0, 0.1F});
  for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(mixer.outputs()[j], j % 2 == 0 ? 0.525F : 0.475F, kSvd);
  EXPECT_EQ(mixer.outputs()[4], 0.0F);
}

TEST_F(MixerTest, MixesNothingWithAnInvalidPrimary) {
  for (int id : {12, 255, -1}) {
    choose(id);
    EXPECT_FALSE(mixer.valid());
    mix({0, 0, -0.5F});
    EXPECT_EQ(mixer.outputs()[0], 0.0F);
  }
  EXPECT_EQ(log.count(Severity::kError), 3);
}

TEST_F(MixerTest, CopiesThePrimaryForADefaultedSecondary) {
  choose(2);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) EXPECT_EQ(parameters.real(secondary_element(i, j)), element(i, j));
  }
}

TEST_F(MixerTest, DoublesTheRuddervatorsOfASecondaryVTail) {
  parameters.set(parameter("RC_F_AXIS"), 0);
  choose(kVTail, kVTail);
  EXPECT_EQ(element(kPitch, 2), 0.5F);
  EXPECT_NEAR(parameters.real(secondary_element(kPitch, 2)), 1.0F, kSvd);
  EXPECT_NEAR(parameters.real(secondary_element(kYaw, 1)), 1.0F, kSvd);
  EXPECT_NEAR(parameters.real(secondary_element(kRoll, 0)), 1.0F, kSvd);
}

TEST_F(MixerTest, GivesNoLiftWithTheEscCalibrationMixer) {
  choose(kEscCalibration);
  mix({0, 0, -1.0F});
  for (std::size_t j = 0; j < 10; ++j) EXPECT_EQ(mixer.outputs()[j], 0.1F);  // idle
}

TEST_F(MixerTest, WarnsOfACannedMixerWithMotorParametersAndOfAWingWithoutItsAxis) {
  parameters.set(parameter("USE_MOTOR_PARAM"), 1);
  choose(2);
  EXPECT_EQ(log.count(Severity::kError), 1);
  parameters.set(parameter("USE_MOTOR_PARAM"), 0);
  choose(kFixedWing);
  EXPECT_EQ(log.count(Severity::kError), 2);
}

struct ChoiceCase {
  std::uint16_t overrides;
  bool forces_primary;
  bool torques_primary;
};

TEST_F(MixerTest, ChoosesPrimaryOrSecondaryPerGroupOfRows) {
  parameters.set(parameter("ARM_SPIN_MOTORS"), 0);
  for (int j = 0; j < 2; ++j) parameters.set(parameter("PRI_MIXER_OUT_0") + j, 2);
  parameters.set(primary_element(2, 0), -0.1F);
  parameters.set(secondary_element(2, 0), -0.2F);
  parameters.set(primary_element(4, 1), 0.1F);
  parameters.set(secondary_element(4, 1), 0.2F);
  choose(kCustomMixer, kCustomMixer);
  for (const ChoiceCase& c :
       {ChoiceCase{0, false, false}, ChoiceCase{0x001, false, true}, ChoiceCase{0x004, false, true},
        ChoiceCase{0x010, false, true}, ChoiceCase{0x040, false, true}, ChoiceCase{0x100, false, true},
        ChoiceCase{0x002, true, false}, ChoiceCase{0x020, true, false}, ChoiceCase{0x200, true, false}}) {
    mix({0, 0, -1.0F, 0, 1.0F}, {.armed = true, .overrides = c.overrides});
    EXPECT_NEAR(mixer.outputs()[0], c.forces_primary ? 0.1F : 0.2F, kRoundOff) << c.overrides;
    EXPECT_NEAR(mixer.outputs()[1], c.torques_primary ? 0.1F : 0.2F, kRoundOff) << c.overrides;
  }
}

TEST_F(MixerTest, TakesFreeInputsFromThePrimaryAlways) {
  parameters.set(parameter("ARM_SPIN_MOTORS"), 0);
  parameters.set(parameter("PRI_MIXER_OUT_3"), 1);
  parameters.set(primary_element(7, 3), 0.5F);
  parameters.set(secondary_element(7, 3), -0.5F);
  choose(kCustomMixer, kCustomMixer);
  mix({0, 0, 0, 0, 0, 0, 0, 0.4F});
  EXPECT_NEAR(mixer.outputs()[3], 0.5F * 0.2F + 0.5F, kRoundOff);
}

TEST_F(MixerTest, DropsYawBelowIdleThrottle) {
  choose(2);
  mix({0, 0, -0.0999F, 0, 0, 0.4F});
  EXPECT_NEAR(mixer.outputs()[0], mixer.outputs()[1], kRoundOff);
  mix({0, 0, -0.2F, 0, 0, 0.4F});
  EXPECT_GT(mixer.outputs()[0], mixer.outputs()[1] + 0.1F);
}

TEST_F(MixerTest, ScalesAllMotorsByTheGreatest) {
  choose(2);
  mix({0, 0, -1.0F, 0, 0, 1.0F});  // 1.25 and 0.75
  EXPECT_NEAR(mixer.outputs()[0], 1.0F, kSvd);
  EXPECT_NEAR(mixer.outputs()[1], 0.6F, kSvd);
  EXPECT_EQ(log.count(Severity::kWarning), 0);
  mix({0, 0, -2.1F});
  EXPECT_EQ(log.count(Severity::kWarning), 1);
  mix({0, 0, -2.1F});
  EXPECT_EQ(log.count(Severity::kWarning), 2) << "in every step";
}

TEST_F(MixerTest, ClampsMotorsToIdleWhenArmedAndToZeroOtherwise) {
  choose(2);
  mix({0, 0, 0});
  EXPECT_EQ(mixer.outputs()[0], 0.1F);
  mix({0, 0, -0.5F}, {.armed = false});
  EXPECT_EQ(mixer.outputs()[0], 0.0F);
  parameters.set(parameter("ARM_SPIN_MOTORS"), 0);
  mixer.configure(parameters);
  mix({0, 0, 0.5F});
  EXPECT_EQ(mixer.outputs()[0], 0.0F);
}

TEST_F(MixerTest, DrivesServosAroundTheirCentreArmedOrNot) {
  parameters.set(parameter("FIXED_WING"), 1);
  parameters.set(parameter("RC_F_AXIS"), 0);
  parameters.set(parameter("REV_ELEVATOR"), 1);
  choose(kFixedWing);
  mix({0.6F, 0, 0, 0.4F, 0.4F, 3.0F}, {.armed = false});
  EXPECT_NEAR(mixer.outputs()[0], 0.7F, kRoundOff);
  EXPECT_NEAR(mixer.outputs()[1], 0.3F, kRoundOff) << "reversed";
  EXPECT_NEAR(mixer.outputs()[2], 1.0F, kRoundOff) << "clamped";
  EXPECT_EQ(mixer.outputs()[4], 0.0F);
  mix({0.6F, 0, 0, 0, 0, 0}, {.armed = true});
  EXPECT_NEAR(mixer.outputs()[4], 0.6F, kRoundOff);
}

TEST_F(MixerTest, TurnsEachSurfaceOfAWingByItsOwnFlag) {
  struct Row {
    const char* flag;
    std::size_t pin;
  };
  for (const Row row : {Row{"REV_AILERON", 0}, Row{"REV_ELEVATOR", 1}, Row{"REV_RUDDER", 2}}) {
    parameters.set_defaults();
    parameters.set(parameter("FIXED_WING"), 1);
    parameters.set(parameter("RC_F_AXIS"), 0);
    parameters.set(find_parameter(row.flag), 1);
    choose(kFixedWing);
    mix({0, 0, 0, 0.2F, 0.4F, 0.6F});
    const float plain[] = {0.6F, 0.7F, 0.8F};
    for (std::size_t pin = 0; pin < 3; ++pin) {
      EXPECT_NEAR(mixer.outputs()[pin], pin == row.pin ? 1.0F - plain[pin] : plain[pin], kRoundOff)
          << row.flag << " at pin " << pin;
    }
    parameters.set(parameter("FIXED_WING"), 0);
    mixer.configure(parameters);
    mix({0.5F, 0, 0, 0.2F, 0.4F, 0.6F});
    EXPECT_NEAR(mixer.outputs()[row.pin], plain[row.pin], kRoundOff) << "of a wing only";
  }
}

TEST_F(MixerTest, NeitherScalesTheMotorsOfAWingNorDropsItsYaw) {
  parameters.set(parameter("FIXED_WING"), 1);
  parameters.set(parameter("RC_F_AXIS"), 0);
  parameters.set(parameter("PRI_MIXER_OUT_0"), 2);
  parameters.set(parameter("PRI_MIXER_OUT_1"), 2);
  parameters.set(parameter("PRI_MIXER_OUT_2"), 1);
  parameters.set(primary_element(0, 0), 3.0F);
  parameters.set(primary_element(0, 1), 0.5F);
  parameters.set(primary_element(5, 2), 1.0F);
  choose(kCustomMixer);
  mix({1.0F, 0, 0, 0, 0, 0});
  EXPECT_EQ(mixer.outputs()[0], 1.0F);
  EXPECT_EQ(mixer.outputs()[1], 0.5F);
  EXPECT_EQ(log.count(Severity::kWarning), 0);
  mix({0, 0, 0, 0, 0, 0.4F});
  EXPECT_NEAR(mixer.outputs()[2], 0.7F, kRoundOff);
}

TEST_F(MixerTest, LeavesAGeneralPurposePinAlone) {
  parameters.set(parameter("PRI_MIXER_OUT_3"), 3);
  parameters.set(primary_element(2, 3), -1.0F);
  choose(kCustomMixer);
  rosflight::RosflightAuxCmd message;
  message.aux_cmd_array[3] = 1.0F;
  message.type_array[3] = 1;
  mixer.take(message);
  mix({0, 0, -0.5F});
  EXPECT_EQ(mixer.outputs()[3], 0.0F) << "neither mixed nor auxiliary";
}

TEST_F(MixerTest, DropsYawByTheForceOnTheThrottleAxis) {
  parameters.set(parameter("RC_F_AXIS"), 0);
  choose(2);
  mix({0, 0, -0.5F, 0, 0, 0.4F});
  EXPECT_NEAR(mixer.outputs()[0], mixer.outputs()[1], kRoundOff) << "nothing along x";
  mix({0.5F, 0, -0.5F, 0, 0, 0.4F});
  EXPECT_GT(mixer.outputs()[0], mixer.outputs()[1] + 0.1F);
}

TEST_F(MixerTest, HoldsAuxiliaryPinsUntilTheyAreCommanded) {
  choose(2);
  rosflight::RosflightAuxCmd message;
  message.aux_cmd_array[4] = 0.5F;
  message.type_array[4] = 1;
  message.aux_cmd_array[12] = 0.7F;
  message.type_array[12] = 2;
  message.aux_cmd_array[0] = 1.0F;  // mixer-driven: cannot be overridden
  message.type_array[0] = 1;
  mixer.take(message);
  mix({0, 0, -0.5F});
  EXPECT_NEAR(mixer.outputs()[4], 0.75F, kRoundOff);
  EXPECT_NEAR(mixer.outputs()[12], 0.7F, kRoundOff);
  EXPECT_NEAR(mixer.outputs()[0], 0.5F, kSvd);
  message.type_array[4] = 0;
  message.aux_cmd_array[4] = -1.0F;
  mixer.take(message);
  mix({0, 0, -0.5F}, {.armed = false});
  EXPECT_NEAR(mixer.outputs()[4], 0.75F, kRoundOff) << "disabled pins keep their last value";
  EXPECT_EQ(mixer.outputs()[12], 0.0F) << "motors stop when disarmed";
}

TEST_F(MixerTest, DropsAnAuxiliaryCommandWithAnIllegalTypeWhole) {
  choose(2);
  rosflight::RosflightAuxCmd message;
  message.aux_cmd_array[4] = 0.5F;
  message.type_array[4] = 1;
  message.type_array[13] = 3;
  mixer.take(message);
  mix({0, 0, -0.5F});
  EXPECT_EQ(mixer.outputs()[4], 0.0F);
}

class MotorMixerTest : public MixerTest {
 protected:
  MotorMixerTest() {
    parameters.set(parameter("USE_MOTOR_PARAM"), 1);
    parameters.set(parameter("PRI_MIXER_OUT_0"), 2);
    parameters.set(primary_element(2, 0), -5000.0F);
    choose(kCustomMixer);
  }
};

TEST_F(MotorMixerTest, ComputesTheVoltageOfTheMotorModel) {
  mix({0, 0, -30.0F}, {.armed = true, .overrides = 0, .density = 1.1F});
  const double w2 = 150000.0;
  const double pi = 3.14159265358979;
  const double volts = 1.1 * std::pow(0.381, 5) * 0.0045 * 0.042 * w2 / (4 * pi * pi * 0.01706) +
                       0.042 * 1.5 + 0.01706 * std::sqrt(w2);
  EXPECT_NEAR(mixer.outputs()[0], volts / 25.0, 1e-6);
}

TEST_F(MotorMixerTest, CommandsTheFrictionVoltageForZeroThrust) {
  parameters.set(parameter("ARM_SPIN_MOTORS"), 0);
  mixer.configure(parameters);
  mix({0, 0, 20.0F});
  EXPECT_NEAR(mixer.outputs()[0], 0.042F * 1.5F / 25.0F, kRoundOff);
}

TEST_F(MotorMixerTest, LeavesServosOutOfTheMotorModel) {
  parameters.set(parameter("PRI_MIXER_OUT_1"), 1);
  parameters.set(primary_element(3, 1), 0.5F);
  choose(kCustomMixer);
  mix({0, 0, -30.0F, 0.4F});
  EXPECT_NEAR(mixer.outputs()[1], 0.6F, kRoundOff);
}

TEST_F(MotorMixerTest, GivesZeroAndAnErrorEachStepWithoutVoltageOrConstant) {
  battery = 0.0F;
  mix({0, 0, -30.0F});
  mix({0, 0, -30.0F});
  EXPECT_EQ(mixer.outputs()[0], 0.1F) << "idle of an armed motor";
  EXPECT_EQ(log.count(Severity::kError), 2);
  battery = 25.0F;
  parameters.set(parameter("MOTOR_KV"), 1e-8F);
  mixer.configure(parameters);
  mix({0, 0, -30.0F});
  EXPECT_EQ(log.count(Severity::kError), 3);
}

struct ThrustCase {
  const char* name;
  float resistance, back_emf, no_load_current, torque_coefficient, voltage;
  double speed, thrust;
};

TEST(MotorModelTest, FindsTheMaximumThrustOfTheWorkedExamples) {
  for (const ThrustCase& c : {ThrustCase{"defaults", 0.042F, 0.01706F, 1.5F, 0.0045F, 25.0F, 1220.7, 292.3},
                              ThrustCase{"x650", 0.085F, 0.02894F, 1.01F, 0.004286F, 25.2F, 798.7, 125.1}}) {
    ParameterStore parameters;
    parameters.set(parameter("MOTOR_RESISTANCE"), c.resistance);
    parameters.set(parameter("MOTOR_KV"), c.back_emf);
    parameters.set(parameter("NO_LOAD_CURRENT"), c.no_load_current);
    parameters.set(parameter("PROP_CQ"), c.torque_coefficient);
    parameters.set(parameter("BATT_VOLT_MAX"), c.voltage);
    EXPECT_NEAR(MotorModel::from(parameters).speed(c.voltage, 1.225F), c.speed, 0.06) << c.name;
    EXPECT_NEAR(maximum_thrust(parameters, 1.225F), c.thrust, 0.06) << c.name;
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
