#include "hil_bridge/virtual_fcu/physical_mixer.hpp"

#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <cmath>
#include <string>
#include <vector>

#include "hil_bridge/virtual_fcu/firmware.hpp"

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr double kLeverArm = 0.2298;  // m
const std::vector<MixerRotor> kQuad = {{kLeverArm, kLeverArm, 1.0},
                                       {-kLeverArm, kLeverArm, -1.0},
                                       {-kLeverArm, -kLeverArm, 1.0},
                                       {kLeverArm, -kLeverArm, -1.0}};

TEST(PhysicalMixerTest, FindsTheNumbersOfTheReferenceSimulator) {
  const auto mixer =
      physical_mixer(kQuad, {.density = 1.074, .diameter = 0.381, .CT = 0.075, .CQ = 0.004286});
  EXPECT_NEAR(mixer[2][0], -5814.79, 0.005);
  EXPECT_NEAR(mixer[3][0], -25303.7, 0.05);
  EXPECT_NEAR(mixer[4][0], 25303.7, 0.05);
  EXPECT_NEAR(mixer[5][0], 267065.9, 0.05);
}

TEST(PhysicalMixerTest, IsTheClosedFormForASymmetricQuad) {
  const MixerPropeller propeller;
  const auto mixer = physical_mixer(kQuad, propeller);
  const double roll[] = {-1, -1, 1, 1};
  const double pitch[] = {1, -1, -1, 1};
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(mixer[2][j] * 4.0 * propeller.thrust_factor(), -1.0, 1e-12);
    EXPECT_NEAR(mixer[3][j] * 4.0 * propeller.thrust_factor() * kLeverArm, roll[j], 1e-12);
    EXPECT_NEAR(mixer[4][j] * 4.0 * propeller.thrust_factor() * kLeverArm, pitch[j], 1e-12);
    EXPECT_NEAR(mixer[5][j] * 4.0 * propeller.torque_factor(), j % 2 == 0 ? 1.0 : -1.0, 1e-12);
  }
  EXPECT_EQ(mixer[0][0], 0.0);
  EXPECT_EQ(mixer[2][4], 0.0);
}

TEST(PhysicalMixerTest, ProducesWhatIsAskedOfAnUnsymmetricHexa) {
  std::vector<MixerRotor> rotors;
  for (int j = 0; j < 6; ++j) {
    const double angle = 0.3 + 1.04 * j;
    rotors.push_back({0.3 * std::cos(angle) + 0.02, 0.35 * std::sin(angle), j % 2 == 0 ? 1.0 : -1.0});
  }
  const MixerPropeller propeller;
  const auto mixer = physical_mixer(rotors, propeller);
  const double wanted[] = {-40.0, 0.5, -0.7, 0.2};
  double made[4] = {};
  for (std::size_t j = 0; j < 6; ++j) {
    double w2 = 0.0;
    for (std::size_t i = 0; i < 4; ++i) w2 += mixer[2 + i][j] * wanted[i];
    made[0] -= propeller.thrust_factor() * w2;
    made[1] -= rotors[j].y * propeller.thrust_factor() * w2;
    made[2] += rotors[j].x * propeller.thrust_factor() * w2;
    made[3] += rotors[j].torque_sign * propeller.torque_factor() * w2;
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(made[i], wanted[i], 1e-9) << i;
}

/// Parameters of a model file, in file order by name.
std::vector<ParameterOverride> parameters_of(const toml::table& file) {
  std::vector<ParameterOverride> result;
  for (const auto& [name, value] : *file["fcu"]["parameters"].as_table()) {
    result.push_back({std::string(name.str()), value.value<double>().value()});
  }
  return result;
}

double number(const toml::table& table, const std::string& key) {
  return table[key].value<double>().value();
}

TEST(ModelFilesTest, GiveTheX650TheMixerOfItsGeometry) {
  const toml::table fcu = toml::parse_file(IRONBIRD_SOURCE_DIR "/models/x650/fcu.toml");
  const toml::table vehicle = toml::parse_file(IRONBIRD_SOURCE_DIR "/models/x650/vehicle.toml");
  const toml::table& parameters = *fcu["fcu"]["parameters"].as_table();
  std::vector<MixerRotor> rotors;
  for (const toml::node& entry : *vehicle["vehicle"]["rotors"].as_array()) {
    const toml::table& rotor = *entry.as_table();
    // The vehicle's direction is that of the rotor; its drag turns the vehicle the other way.
    rotors.push_back({rotor["position"][0].value<double>().value(),
                      rotor["position"][1].value<double>().value(), -number(rotor, "direction")});
  }
  const auto expected = physical_mixer(rotors, {.density = 1.074,  // frame file
                                                .diameter = number(parameters, "PROP_DIAMETER"),
                                                .CT = number(parameters, "PROP_CT"),
                                                .CQ = number(parameters, "PROP_CQ")});
  constexpr double kDigits = 0.006;  // the file has two digits after the point
  for (int i = 0; i < kMixerInputs; ++i) {
    for (int j = 0; j < kMixerOutputs; ++j) {
      const std::string name = "PRI_MIXER_" + std::to_string(i) + "_" + std::to_string(j);
      const double stored = parameters.contains(name) ? number(parameters, name) : 0.0;
      EXPECT_NEAR(stored, expected[i][j], kDigits) << name;
    }
  }
}

TEST(ModelFilesTest, GiveTheX650TheMotorOfItsVehicle) {
  const toml::table fcu = toml::parse_file(IRONBIRD_SOURCE_DIR "/models/x650/fcu.toml");
  const toml::table vehicle = toml::parse_file(IRONBIRD_SOURCE_DIR "/models/x650/vehicle.toml");
  const toml::table& parameters = *fcu["fcu"]["parameters"].as_table();
  const toml::table& rotor = *vehicle["vehicle"]["rotor"].as_table();
  EXPECT_EQ(number(parameters, "MOTOR_RESISTANCE"), number(rotor, "resistance"));
  EXPECT_EQ(number(parameters, "MOTOR_KV"), number(rotor, "K_V"));
  EXPECT_EQ(number(parameters, "NO_LOAD_CURRENT"), number(rotor, "no_load_current"));
  EXPECT_EQ(number(parameters, "PROP_DIAMETER"), number(rotor, "diameter"));
  EXPECT_EQ(number(parameters, "PROP_CT"), rotor["CT"][0].value<double>().value());
  EXPECT_EQ(number(parameters, "PROP_CQ"), rotor["CQ"][0].value<double>().value());
}

TEST(ModelFilesTest, FailTheX650SafeJustBelowHoverAtItsField) {
  constexpr double kThinAir = 1.070 / 1.074;  // standard atmosphere at 1387 m, against the air of the mixer
  const toml::table fcu = toml::parse_file(IRONBIRD_SOURCE_DIR "/models/x650/fcu.toml");
  const Firmware firmware(parameters_of(fcu));
  const double thrust = static_cast<double>(firmware.parameters().real(parameter("FAILSAFE_THR")) *
                                            firmware.parameters().real(parameter("RC_MAX_THR")) *
                                            firmware.controller().maximum_thrust());
  constexpr double kWeight = 3.9 * 9.80665;  // N
  EXPECT_LT(kThinAir * thrust, kWeight);
  EXPECT_GT(kThinAir * thrust, 0.94 * kWeight);
}

TEST(ModelFilesTest, BootWithNothingButTheImuLeftToCalibrate) {
  for (const char* model : {"x650", "rosflight_multirotor"}) {
    const toml::table fcu =
        toml::parse_file(std::string(IRONBIRD_SOURCE_DIR "/models/") + model + "/fcu.toml");
    const Firmware firmware(parameters_of(fcu));
    EXPECT_EQ(firmware.arming().errors(), kUncalibratedImu) << model;
    EXPECT_TRUE(firmware.mixer().valid()) << model;
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
