#include "hil_bridge/virtual_fcu/mixer.hpp"

#include <algorithm>
#include <cmath>

#include "hil_bridge/virtual_fcu/command_mux.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kLeastTorqueConstant = 1e-7F;
constexpr float kLeastVoltage = 1e-4F;
constexpr float kWorthAWarning = 2.0F;

OutputKind output_kind(std::int32_t parameter) {
  return static_cast<OutputKind>(std::clamp(static_cast<int>(parameter), 0, 3));
}

}  // namespace

void Mixer::configure(const ParameterStore& parameters) {
  use_motor_model_ = parameters.on(parameter("USE_MOTOR_PARAM"));
  fixed_wing_ = parameters.on(parameter("FIXED_WING"));
  spin_when_armed_ = parameters.on(parameter("ARM_SPIN_MOTORS"));
  idle_ = parameters.real(parameter("MOTOR_IDLE_THR"));
  force_axis_ = static_cast<std::size_t>(
      std::clamp(static_cast<int>(parameters.integer(parameter("RC_F_AXIS"))), 0, 2));
  reversed_ = {parameters.on(parameter("REV_AILERON")), parameters.on(parameter("REV_ELEVATOR")),
               parameters.on(parameter("REV_RUDDER"))};
  motor_ = MotorModel::from(parameters);
}

void Mixer::load_elements(const ParameterStore& parameters) {
  for (int i = 0; i < kMixerInputs; ++i) {
    for (int j = 0; j < kMixerOutputs; ++j) {
      primary_[i][j] = parameters.real(primary_element(i, j));
      secondary_[i][j] = parameters.real(secondary_element(i, j));
    }
  }
  for (int j = 0; j < kMixerOutputs; ++j) {
    kinds_[j] = output_kind(parameters.integer(parameter("PRI_MIXER_OUT_0") + j));
  }
}

void Mixer::set_element(const ParameterStore& parameters, ParameterId id) {
  constexpr int kElements = kMixerInputs * kMixerOutputs;
  const int primary = id.index - primary_element(0, 0).index;
  const int secondary = id.index - secondary_element(0, 0).index;
  const int kind = id.index - parameter("PRI_MIXER_OUT_0").index;
  if (primary >= 0 && primary < kElements) {
    primary_[primary % kMixerInputs][primary / kMixerInputs] = parameters.real(id);
  } else if (secondary >= 0 && secondary < kElements) {
    secondary_[secondary % kMixerInputs][secondary / kMixerInputs] = parameters.real(id);
  } else if (kind >= 0 && kind < kMixerOutputs) {
    kinds_[kind] = output_kind(parameters.integer(id));
  }
}

bool Mixer::rebuild(ParameterStore& parameters, TextLog& log) {
  outputs_ = {};
  const int primary = parameters.integer(parameter("PRIMARY_MIXER"));
  valid_ = primary >= 0 && primary < kMixerIds;
  if (!valid_) {
    log.write(Severity::kError, "PRIMARY_MIXER is not a mixer");
    return false;
  }
  choose_primary(primary, parameters, log);
  choose_secondary(parameters.integer(parameter("SECONDARY_MIXER")), parameters, log);
  load_elements(parameters);
  return true;
}

void Mixer::choose_primary(int id, ParameterStore& parameters, TextLog& log) {
  if (id == kCustomMixer) {
    log.write(Severity::kInfo, "primary mixer: saved custom values");
    return;
  }
  const CannedMixer mixer = canned_mixer(id);
  const bool wing = id == kFixedWing || id == kVTail;
  if (parameters.on(parameter("USE_MOTOR_PARAM"))) {
    log.write(Severity::kError, "canned mixer with USE_MOTOR_PARAM: tiny outputs");
  }
  if (wing && parameters.integer(parameter("RC_F_AXIS")) != 0) {
    log.write(Severity::kError, "fixed-wing mixer wants RC_F_AXIS 0");
  }
  if (!wing) log.write(Severity::kInfo, TextLine("inverting mixer ").add(mixer.name).text());
  const MixerMatrix matrix = wing ? mixer.matrix : inverted(mixer.matrix);
  for (int j = 0; j < kMixerOutputs; ++j) {
    parameters.set(parameter("PRI_MIXER_OUT_0") + j, static_cast<std::int32_t>(mixer.kinds[j]));
    parameters.set(parameter("PRI_MIXER_PWM_0") + j, mixer.rates[j]);
    for (int i = 0; i < kMixerInputs; ++i) parameters.set(primary_element(i, j), matrix[i][j]);
  }
}

void Mixer::choose_secondary(int id, ParameterStore& parameters, TextLog& log) {
  if (id == kCustomMixer) {
    log.write(Severity::kInfo, "secondary mixer: saved custom values");
    return;
  }
  const bool canned = id >= 0 && id < kCustomMixer;
  // Wings should be exempt from the inversion here as they are as primary mixers; the firmware inverts them.
  const MixerMatrix matrix = canned ? inverted(canned_mixer(id).matrix) : MixerMatrix{};
  for (int j = 0; j < kMixerOutputs; ++j) {
    for (int i = 0; i < kMixerInputs; ++i) {
      const float element = canned ? matrix[i][j] : parameters.real(primary_element(i, j));
      parameters.set(secondary_element(i, j), element);
    }
  }
}

void Mixer::take(const rosflight::RosflightAuxCmd& message) {
  constexpr std::uint8_t kGreatestType = 2;
  for (const std::uint8_t type : message.type_array) {
    if (type > kGreatestType) return;
  }
  for (std::size_t pin = 0; pin < kOutputs; ++pin) {
    auxiliary_[pin] = message.aux_cmd_array[pin];
    auxiliary_kinds_[pin] = static_cast<OutputKind>(message.type_array[pin]);
  }
}

Mixer::Row Mixer::sums(const std::array<float, kMixerInputs>& u, std::uint16_t overrides) const {
  const MixerMatrix& forces = (overrides & kThrottleOverrides) != 0 ? primary_ : secondary_;
  const MixerMatrix& torques = (overrides & kAttitudeOverrides) != 0 ? primary_ : secondary_;
  Row sum{};
  for (std::size_t i = 0; i < kMixerInputs; ++i) {
    if (u[i] == 0.0F) continue;
    const MixerMatrix& matrix = i < kRoll ? forces : i < kFirstFree ? torques : primary_;
    const Row& row = matrix[i];
    for (std::size_t j = 0; j < kMixerOutputs; ++j) sum[j] += u[i] * row[j];
  }
  return sum;
}

void Mixer::apply_motor_model(Row& row, const MixerConditions& conditions, TextLog& log) const {
  const bool possible =
      motor_.back_emf >= kLeastTorqueConstant && conditions.battery_voltage >= kLeastVoltage;
  if (!possible) log.write(Severity::kError, "motor model divides by zero: voltage or KV");
  const float load = possible ? motor_.load_voltage(conditions.density) : 0.0F;
  const float friction = motor_.resistance * motor_.no_load_current;
  for (std::size_t j = 0; j < kMixerOutputs; ++j) {
    if (kinds_[j] != OutputKind::kMotor) continue;
    const float squared_speed = std::max(0.0F, row[j]);
    const float voltage = load * squared_speed + friction + motor_.back_emf * std::sqrt(squared_speed);
    row[j] = possible ? voltage / conditions.battery_voltage : 0.0F;
  }
}

void Mixer::scale_motors(Row& row, TextLog& log) const {
  float greatest = 1.0F;
  for (std::size_t j = 0; j < kMixerOutputs; ++j) {
    if (kinds_[j] == OutputKind::kMotor) greatest = std::max(greatest, std::fabs(row[j]));
  }
  if (greatest > kWorthAWarning) {
    log.write(Severity::kWarning, TextLine("motor demand before scaling: ").add(greatest).text());
  }
  if (greatest <= 1.0F) return;
  for (std::size_t j = 0; j < kMixerOutputs; ++j) {
    if (kinds_[j] == OutputKind::kMotor) row[j] /= greatest;
  }
}

void Mixer::write(std::size_t pin, OutputKind kind, float value, bool armed) {
  if (kind == OutputKind::kServo) {
    const float output = 0.5F * std::clamp(value, -1.0F, 1.0F) + 0.5F;
    if (std::isfinite(output)) outputs_[pin] = output;
  } else if (kind == OutputKind::kMotor) {
    const float least = spin_when_armed_ ? idle_ : 0.0F;
    const float output = !armed ? 0.0F : value > 1.0F ? 1.0F : value < least ? least : value;
    outputs_[pin] = std::isfinite(output) ? output : 0.0F;
  }
}

void Mixer::mix(std::array<float, kMixerInputs> u, const MixerConditions& conditions, TextLog& log) {
  if (!valid_) return;
  if (fixed_wing_) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (reversed_[k]) u[kRoll + k] = -u[kRoll + k];
    }
  } else if (std::fabs(u[force_axis_]) < idle_) {
    u[kYaw] = 0.0F;
  }
  Row row = sums(u, conditions.overrides);
  if (!fixed_wing_) {
    if (use_motor_model_) apply_motor_model(row, conditions, log);
    scale_motors(row, log);
  }
  for (std::size_t pin = 0; pin < kOutputs; ++pin) {
    const bool mixed = pin < kMixerOutputs && kinds_[pin] != OutputKind::kAuxiliary;
    if (mixed) {
      write(pin, kinds_[pin], row[pin], conditions.armed);
    } else {
      write(pin, auxiliary_kinds_[pin], auxiliary_[pin], conditions.armed);
    }
  }
}

}  // namespace ironbird::hil_bridge::virtual_fcu
