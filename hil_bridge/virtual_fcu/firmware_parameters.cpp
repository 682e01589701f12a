#include <cmath>
#include <limits>
#include <stdexcept>

#include "hil_bridge/virtual_fcu/firmware.hpp"

// Boot, and what a changed parameter sets in motion.

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

void apply_saved(ParameterStore& parameters, const ParameterOverride& saved) {
  const ParameterId id = find_parameter(saved.name);
  if (id.index == kParameterCount) {
    throw std::invalid_argument("fcu.parameters." + saved.name + ": the firmware has no such parameter");
  }
  if (kParameterTable[id.index].type == ParameterType::kReal) {
    parameters.set(id, static_cast<float>(saved.value));
    return;
  }
  constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr double kGreatest = std::numeric_limits<std::int32_t>::max();
  if (!(saved.value >= kLeast && saved.value <= kGreatest) || saved.value != std::trunc(saved.value)) {
    throw std::invalid_argument("fcu.parameters." + saved.name + " = " + std::to_string(saved.value) +
                                ", must be a whole number of 32 bits");
  }
  parameters.set(id, static_cast<std::int32_t>(saved.value));
}

bool within(ParameterId id, ParameterId first, ParameterId last) {
  return first <= id && id <= last;
}

bool changes_controller(ParameterId id) {
  return within(id, parameter("PID_ROLL_RATE_P"), parameter("PID_PITCH_ANG_D")) ||
         id == parameter("PID_TAU") || within(id, parameter("MOTOR_RESISTANCE"), parameter("PROP_CT")) ||
         id == parameter("BATT_VOLT_MAX") || id == parameter("NUM_MOTORS") || id == parameter("RC_MAX_THR");
}

bool changes_mixer(ParameterId id) {
  return id == parameter("PRIMARY_MIXER") || id == parameter("SECONDARY_MIXER") ||
         id == parameter("USE_MOTOR_PARAM") || id == parameter("RC_F_AXIS");
}

}  // namespace

Firmware::Firmware(std::span<const ParameterOverride> saved, bool undefined_when_inverted)
    : filter_(undefined_when_inverted) {
  for (const ParameterOverride& value : saved) apply_saved(parameters_, value);
  parameters_.save();
  boot();
}

void Firmware::boot() {
  arming_.handle(Event::kInitialized);
  parameters_.listen(this);
  rebuild_mixer();
  map_switches();
  baro_calibration_.start();
  airspeed_calibration_.start();
  set_error(kUncalibratedImu, imu_biases_are_zero(parameters_));
  battery_.start(parameters_);
  configure_parts();
  filter_.reset();
  controller_.rebuild(parameters_, density_);
  rebuild_failsafe();
}

void Firmware::configure_parts() {
  rc_.configure(parameters_);
  mux_.configure(parameters_);
  filter_.configure(parameters_);
  controller_.configure(parameters_);
  mixer_.configure(parameters_);
  battery_.configure(parameters_);
  corrections_.configure(parameters_);
}

void Firmware::parameter_changed(ParameterId id) {
  configure_parts();
  mixer_.set_element(parameters_, id);
  if (changes_controller(id)) controller_.rebuild(parameters_, density_);
  if (changes_mixer(id)) rebuild_mixer();
  if (id == parameter("FAILSAFE_THR") || id == parameter("FIXED_WING")) rebuild_failsafe();
  if (within(id, parameter("RC_ATT_OVRD_CHN"), parameter("RC_ARM_CHN")) ||
      within(id, parameter("SWITCH_5_DIR"), parameter("SWITCH_8_DIR"))) {
    map_switches();
  }
  if (within(id, parameter("IMU_ROLL"), parameter("IMU_YAW")) && imu_biases_are_zero(parameters_)) {
    set_error(kUncalibratedImu, true);
  }
  if (within(id, parameter("BATT_VOLT_LPF"), parameter("BATT_CURR_LPF")))
    battery_.change_filters(parameters_);
  telemetry_.send_parameter(parameters_, id);
}

void Firmware::rebuild_mixer() {
  mixer_.configure(parameters_);
  set_error(kInvalidMixer, !mixer_.rebuild(parameters_, telemetry_));
}

void Firmware::rebuild_failsafe() {
  mux_.rebuild_failsafe(parameters_);
  const float throttle = parameters_.real(parameter("FAILSAFE_THR"));
  const bool valid = throttle >= 0.0F && throttle <= 1.0F;
  set_error(kInvalidFailsafe, !valid && !parameters_.on(parameter("FIXED_WING")));
}

void Firmware::map_switches() {
  struct Named {
    Switch which;
    std::string_view name;
  };
  constexpr Named kNamed[] = {{Switch::kArm, "arm"},
                              {Switch::kAttitudeOverride, "attitude override"},
                              {Switch::kThrottleOverride, "throttle override"},
                              {Switch::kAttitudeMode, "attitude mode"}};
  rc_.map_switches(parameters_);
  for (const Named& entry : kNamed) {
    TextLine line(entry.name);
    if (rc_.mapped(entry.which)) {
      line.add(" switch on channel ").add(rc_.channel(entry.which));
    } else {
      line.add(" switch has no channel");
    }
    telemetry_.write(Severity::kInfo, line.text());
  }
}

}  // namespace ironbird::hil_bridge::virtual_fcu
