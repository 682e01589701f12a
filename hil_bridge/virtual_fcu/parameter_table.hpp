#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "hil_bridge/rosflight/vocabulary.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

using rosflight::kParameterCount;
using rosflight::ParameterType;

/// A parameter's place in the table, which is also its index on the wire.
struct ParameterId {
  std::uint16_t index = 0;
  friend constexpr auto operator<=>(ParameterId, ParameterId) = default;
  constexpr ParameterId operator+(int steps) const { return {static_cast<std::uint16_t>(index + steps)}; }
};

inline constexpr int kMixerInputs = 10;   ///< forces, torques and four free inputs
inline constexpr int kMixerOutputs = 10;  ///< outputs that the mixer can drive
inline constexpr std::size_t kNameLength = 16;

/// What the firmware knows of one parameter.
struct ParameterInfo {
  std::array<char, kNameLength> name{};  ///< zero padded; a name of 16 characters has no terminator
  ParameterType type = ParameterType::kInteger;
  std::uint32_t default_bits = 0;
  const char* unit = "1";
  const char* meaning = "";
  double lower =
      -std::numeric_limits<float>::max();  ///< what a set-up may ask for; the firmware takes anything
  double upper = std::numeric_limits<float>::max();
};

namespace detail {

constexpr ParameterInfo integer(std::string_view name, std::int32_t value, const char* unit,
                                const char* meaning, double lower = std::numeric_limits<std::int32_t>::min(),
                                double upper = std::numeric_limits<std::int32_t>::max()) {
  return {rosflight::field_of<kNameLength>(name),
          ParameterType::kInteger,
          std::bit_cast<std::uint32_t>(value),
          unit,
          meaning,
          lower,
          upper};
}

constexpr ParameterInfo real(std::string_view name, float value, const char* unit, const char* meaning,
                             double lower = ParameterInfo{}.lower, double upper = ParameterInfo{}.upper) {
  return {rosflight::field_of<kNameLength>(name),
          ParameterType::kReal,
          std::bit_cast<std::uint32_t>(value),
          unit,
          meaning,
          lower,
          upper};
}

/// "PRI_MIXER_OUT_" and a digit, and the like.
constexpr std::array<char, kNameLength> numbered(std::string_view stem, int number) {
  std::array<char, kNameLength> name = rosflight::field_of<kNameLength>(stem);
  name[stem.size()] = static_cast<char>('0' + number);
  return name;
}

/// "PRI_MIXER_" and input row, output column.
constexpr std::array<char, kNameLength> element(std::string_view stem, int input, int output) {
  std::array<char, kNameLength> name = numbered(stem, input);
  name[stem.size() + 1] = '_';
  name[stem.size() + 2] = static_cast<char>('0' + output);
  return name;
}

inline constexpr auto kBeforeMixer = std::to_array<ParameterInfo>({
    integer("BAUD_RATE", 921600, "Bd", "UART link speed, read at boot"),
    integer("SERIAL_DEVICE", 0, "1", "link port, read at boot"),
    integer("NUM_MOTORS", 4, "1", "motors counted in the maximum thrust", 1, 10),
    real("MOTOR_RESISTANCE", 0.042F, "ohm", "winding resistance", 0.0001, 10),
    real("MOTOR_KV", 0.01706F, "V*s/rad", "back-EMF constant, and torque constant", 1e-05, 10),
    real("NO_LOAD_CURRENT", 1.5F, "A", "current of a free motor", 0, 50),
    real("PROP_DIAMETER", 0.381F, "m", "propeller diameter", 0.01, 5),
    real("PROP_CT", 0.075F, "1", "thrust coefficient", 1e-06, 10),
    real("PROP_CQ", 0.0045F, "1", "torque coefficient", 1e-09, 10),
    real("BATT_VOLT_MAX", 25.0F, "V", "voltage of the maximum thrust, and first filtered voltage", 1, 1000),
    integer("USE_MOTOR_PARAM", 0, "1", "1: the mixer's sums are squared speeds for the motor model", 0, 1),
});

inline constexpr auto kAfterMixer = std::to_array<ParameterInfo>({
    integer("SYS_ID", 1, "1", "system id on the link; one that a byte cannot hold is never addressed", 1,
            255),
    real("PID_ROLL_RATE_P", 0.070F, "", "roll-rate loop"),
    real("PID_ROLL_RATE_I", 0.0F, "", "roll-rate loop"),
    real("PID_ROLL_RATE_D", 0.0F, "", "roll-rate loop"),
    real("PID_PITCH_RATE_P", 0.070F, "", "pitch-rate loop"),
    real("PID_PITCH_RATE_I", 0.0F, "", "pitch-rate loop"),
    real("PID_PITCH_RATE_D", 0.0F, "", "pitch-rate loop"),
    real("PID_YAW_RATE_P", 0.25F, "", "yaw-rate loop"),
    real("PID_YAW_RATE_I", 0.0F, "", "yaw-rate loop"),
    real("PID_YAW_RATE_D", 0.0F, "", "yaw-rate loop"),
    real("PID_ROLL_ANG_P", 0.15F, "", "roll-angle loop, torque per angle"),
    real("PID_ROLL_ANG_I", 0.0F, "", "roll-angle loop"),
    real("PID_ROLL_ANG_D", 0.05F, "", "roll-angle loop, acts on the rate"),
    real("PID_PITCH_ANG_P", 0.15F, "", "pitch-angle loop, torque per angle"),
    real("PID_PITCH_ANG_I", 0.0F, "", "pitch-angle loop"),
    real("PID_PITCH_ANG_D", 0.05F, "", "pitch-angle loop, acts on the rate"),
    real("X_EQ_TORQUE", 0.0F, "", "added to the roll torque in every mode"),
    real("Y_EQ_TORQUE", 0.0F, "", "added to the pitch torque in every mode"),
    real("Z_EQ_TORQUE", 0.0F, "", "added to the yaw torque in every mode"),
    real("PID_TAU", 0.05F, "s", "time constant of the derivative filters", 0, 10),
    real("MOTOR_IDLE_THR", 0.1F, "1", "least motor output when armed; below it yaw is dropped", 0, 1),
    real("FAILSAFE_THR", -1.0F, "1", "throttle in failsafe, 0..1; outside blocks arming", 0, 1),
    integer("ARM_SPIN_MOTORS", 1, "1", "hold MOTOR_IDLE_THR when armed", 0, 1),
    integer("FILT_INIT_T", 3000, "ms", "how long after boot the filter's gains are high", 0, 60000),
    real("FILT_ACC_KP", 0.5F, "1/s", "accelerometer correction gain"),
    real("FILT_KI", 0.01F, "1/s", "gyro-bias gain"),
    real("FILT_EXT_KP", 1.5F, "1/s", "external-attitude gain"),
    real("FILT_ACC_MARGIN", 0.1F, "1", "accepted relative deviation of the accelerometer's norm from g"),
    integer("FILT_QUAD_INT", 1, "1", "quadratic smoothing of the gyro", 0, 1),
    integer("FILT_MAT_EXP", 1, "1", "closed-form rotation update; 0: Euler step", 0, 1),
    integer("FILT_USE_ACC", 1, "1", "use the accelerometer", 0, 1),
    integer("ARM_CAL_GYRO", 0, "1", "calibrate the gyro on every arming", 0, 1),
    real("GYRO_XY_LPF", 0.3F, "1", "low-pass constant, larger is slower", 0, 1),
    real("GYRO_Z_LPF", 0.3F, "1", "low-pass constant, larger is slower", 0, 1),
    real("ACC_LPF", 0.5F, "1", "low-pass constant, larger is slower", 0, 1),
    real("GYRO_X_BIAS", 0.0F, "rad/s", "subtracted"),
    real("GYRO_Y_BIAS", 0.0F, "rad/s", "subtracted"),
    real("GYRO_Z_BIAS", 0.0F, "rad/s", "subtracted"),
    real("ACC_X_BIAS", 0.0F, "m/s^2", "subtracted"),
    real("ACC_Y_BIAS", 0.0F, "m/s^2", "subtracted"),
    real("ACC_Z_BIAS", 0.0F, "m/s^2", "subtracted"),
    real("ACC_X_TEMP_COMP", 0.0F, "m/s^2/K", "times IMU temperature, subtracted"),
    real("ACC_Y_TEMP_COMP", 0.0F, "m/s^2/K", "times IMU temperature, subtracted"),
    real("ACC_Z_TEMP_COMP", 0.0F, "m/s^2/K", "times IMU temperature, subtracted"),
    real("MAG_CAL_A00", 1.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A01", 0.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A02", 0.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A10", 0.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A11", 1.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A12", 0.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A20", 0.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A21", 0.0F, "1", "soft-iron matrix"),
    real("MAG_CAL_A22", 1.0F, "1", "soft-iron matrix"),
    real("MAG_X_BIAS", 0.0F, "T", "hard iron, subtracted"),
    real("MAG_Y_BIAS", 0.0F, "T", "hard iron, subtracted"),
    real("MAG_Z_BIAS", 0.0F, "T", "hard iron, subtracted"),
    real("BARO_BIAS", 0.0F, "Pa", "mean ground pressure; in no formula"),
    real("GROUND_LEVEL", 1387.0F, "m", "pressure altitude of BARO_BIAS; in no formula"),
    real("DIFF_PRESS_BIAS", 0.0F, "Pa", "subtracted"),
    integer("RC_TYPE", 0, "1", "0 PPM, 1 SBUS", 0, 1),
    integer("RC_X_CHN", 0, "1", "roll channel, from 0", 0, 7),
    integer("RC_Y_CHN", 1, "1", "pitch channel", 0, 7),
    integer("RC_Z_CHN", 3, "1", "yaw channel", 0, 7),
    integer("RC_F_CHN", 2, "1", "throttle channel", 0, 7),
    integer("RC_F_AXIS", 2, "1", "force axis of the throttle stick: 0 x, 1 y, 2 z", 0, 2),
    integer("RC_ATT_OVRD_CHN", 4, "1", "attitude override switch, -1 none", -1, 7),
    integer("RC_THR_OVRD_CHN", 4, "1", "throttle override switch, -1 none", -1, 7),
    integer("RC_ATT_CTRL_CHN", -1, "1", "rate or angle switch, -1: RC_ATT_MODE", -1, 7),
    integer("RC_ARM_CHN", -1, "1", "arm switch, -1: arm with the sticks", -1, 7),
    integer("RC_NUM_CHN", 6, "1", "channels that must be valid", 1, 24),
    integer("SWITCH_5_DIR", 1, "1", "direction of channel 4; negative: inverted"),
    integer("SWITCH_6_DIR", 1, "1", "direction of channel 5"),
    integer("SWITCH_7_DIR", 1, "1", "direction of channel 6"),
    integer("SWITCH_8_DIR", 1, "1", "direction of channel 7"),
    real("RC_OVRD_DEV", 0.1F, "1", "stick deviation that takes over", 0, 1),
    integer("RC_OVRD_LAG_T", 1000, "ms", "how long the takeover outlasts the stick", 0, 100000),
    integer("TAKE_MIN_THR", 1, "1", "the lower throttle wins", 0, 1),
    real("RC_MAX_THR", 0.7F, "1", "factor on every throttle", 0, 1),
    integer("RC_ATT_MODE", 1, "1", "0 rate, 1 angle, without a selector switch", 0, 1),
    real("RC_MAX_ROLL", 0.786F, "rad", "at full stick"),
    real("RC_MAX_PITCH", 0.786F, "rad", "at full stick"),
    real("RC_MAX_ROLLRATE", 3.14159F, "rad/s", "at full stick"),
    real("RC_MAX_PITCHRATE", 3.14159F, "rad/s", "at full stick"),
    real("RC_MAX_YAWRATE", 1.507F, "rad/s", "at full stick"),
    integer("PRIMARY_MIXER", 255, "1", "mixer under the pilot's control; 255 blocks arming", 0, 11),
    integer("SECONDARY_MIXER", 255, "1", "mixer under the companion's control; 12 and up: the primary", 0,
            11),
    integer("FIXED_WING", 0, "1", "1: sticks pass straight to the mixer", 0, 1),
    integer("REV_ELEVATOR", 0, "1", "fixed wing: flips u4", 0, 1),
    integer("REV_AILERON", 0, "1", "fixed wing: flips u3", 0, 1),
    integer("REV_RUDDER", 0, "1", "fixed wing: flips u5", 0, 1),
    real("IMU_ROLL", 0.0F, "deg", "mounting angle"),
    real("IMU_PITCH", 0.0F, "deg", "mounting angle"),
    real("IMU_YAW", 0.0F, "deg", "mounting angle"),
    real("MAG_ROLL", 0.0F, "deg", "mounting angle"),
    real("MAG_PITCH", 0.0F, "deg", "mounting angle"),
    real("MAG_YAW", 0.0F, "deg", "mounting angle"),
    real("RC_ARM_THRESHOLD", 0.15F, "1", "stick margin of the arming gestures", 0, 1),
    integer("OFFBOARD_TIMEOUT", 100, "ms", "how long a command of the companion lives", 0, 100000),
    real("BATT_VOLT_MULT", 1.0F, "1", "factor on the measured voltage"),
    real("BATT_CURR_MULT", 1.0F, "1", "factor on the measured current"),
    real("BATT_VOLT_LPF", 0.995F, "1", "low-pass constant; the saved value is not applied at boot", 0, 1),
    real("BATT_CURR_LPF", 0.995F, "1", "low-pass constant; the saved value is not applied at boot", 0, 1),
});

constexpr std::array<ParameterInfo, kParameterCount> make_table() {
  std::array<ParameterInfo, kParameterCount> table{};
  std::size_t next = 0;
  for (const ParameterInfo& row : kBeforeMixer) table[next++] = row;
  for (int j = 0; j < kMixerOutputs; ++j) {
    table[next++] = {numbered("PRI_MIXER_OUT_", j),
                     ParameterType::kInteger,
                     0,
                     "1",
                     "kind of output: 0 auxiliary, 1 servo, 2 motor, 3 GPIO",
                     0.0,
                     3.0};
  }
  for (int j = 0; j < kMixerOutputs; ++j) {
    table[next++] = {
        numbered("PRI_MIXER_PWM_", j), ParameterType::kReal, 0, "Hz", "pulse rate of an output", 0.0, 50e3};
  }
  for (const std::string_view stem : {std::string_view("PRI_MIXER_"), std::string_view("SEC_MIXER_")}) {
    for (int j = 0; j < kMixerOutputs; ++j) {
      for (int i = 0; i < kMixerInputs; ++i) {
        table[next++] = {element(stem, i, j), ParameterType::kReal, 0, "", "mixer, input row, output column"};
      }
    }
  }
  for (const ParameterInfo& row : kAfterMixer) table[next++] = row;
  if (next != kParameterCount) throw std::logic_error("the parameter table is incomplete");
  return table;
}

}  // namespace detail

/// Every parameter of the firmware in wire order: 333 rows, the only place where names and defaults stand.
inline constexpr std::array<ParameterInfo, kParameterCount> kParameterTable = detail::make_table();

/// The place of a name, or kParameterCount.
constexpr ParameterId find_parameter(std::string_view name) {
  for (std::uint16_t k = 0; k < kParameterCount; ++k) {
    if (rosflight::text_of(kParameterTable[k].name) == name) return {k};
  }
  return {kParameterCount};
}

/// The place of a name, looked up while compiling: a misspelt name does not compile.
consteval ParameterId parameter(std::string_view name) {
  const ParameterId id = find_parameter(name);
  if (id.index == kParameterCount) throw std::logic_error("no such parameter");
  return id;
}

/// Element of the primary mixer: `input` row, `output` column, both 0..9.
constexpr ParameterId primary_element(int input, int output) {
  return parameter("PRI_MIXER_0_0") + (kMixerInputs * output + input);
}

/// Element of the secondary mixer.
constexpr ParameterId secondary_element(int input, int output) {
  return parameter("SEC_MIXER_0_0") + (kMixerInputs * output + input);
}

}  // namespace ironbird::hil_bridge::virtual_fcu
