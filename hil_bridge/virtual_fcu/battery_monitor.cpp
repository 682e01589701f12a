#include "hil_bridge/virtual_fcu/battery_monitor.hpp"

#include <cmath>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kBootLowPass = 0.995F;

// Far beyond what any multirotor's battery or sensor shows: what exceeds it is no reading.
constexpr float kMostVoltage = 1.0e3F;  // V
constexpr float kMostCurrent = 1.0e4F;  // A

void low_pass(float alpha, float measured, float most, float& filtered) {
  if (std::fabs(measured) <= most) filtered = (1.0F - alpha) * measured + alpha * filtered;
}

}  // namespace

void BatteryMonitor::start(const ParameterStore& parameters) {
  voltage_ = parameters.real(parameter("BATT_VOLT_MAX"));
  current_ = 0.0F;
  voltage_lpf_ = kBootLowPass;
  current_lpf_ = kBootLowPass;
  configure(parameters);
}

void BatteryMonitor::configure(const ParameterStore& parameters) {
  const float voltage_factor = parameters.real(parameter("BATT_VOLT_MULT"));
  const float current_factor = parameters.real(parameter("BATT_CURR_MULT"));
  if (voltage_factor != 0.0F) voltage_factor_ = voltage_factor;
  if (current_factor != 0.0F) current_factor_ = current_factor;
}

void BatteryMonitor::change_filters(const ParameterStore& parameters) {
  voltage_lpf_ = parameters.real(parameter("BATT_VOLT_LPF"));
  current_lpf_ = parameters.real(parameter("BATT_CURR_LPF"));
}

void BatteryMonitor::add(const BatteryInput& sample) {
  low_pass(voltage_lpf_, sample.voltage * voltage_factor_, kMostVoltage, voltage_);
  low_pass(current_lpf_, sample.current * current_factor_, kMostCurrent, current_);
}

}  // namespace ironbird::hil_bridge::virtual_fcu
