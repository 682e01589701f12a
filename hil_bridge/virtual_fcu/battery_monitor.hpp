#pragma once

#include "hil_bridge/virtual_fcu/board.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// Low-passes voltage and current. There is no warning, no capacity and no failsafe in it.
class BatteryMonitor {
 public:
  /// At boot: starts from BATT_VOLT_MAX with the firmware's own low-pass constants; the saved ones do not
  /// act.
  void start(const ParameterStore& parameters);
  /// Takes over the multipliers; a zero is ignored.
  void configure(const ParameterStore& parameters);
  /// Takes over the low-pass constants: only when they change.
  void change_filters(const ParameterStore& parameters);

  /// A voltage or current that is not finite changes nothing; each is judged for itself.
  void add(const BatteryInput& sample);

  float voltage() const { return voltage_; }  ///< V
  float current() const { return current_; }  ///< A

 private:
  float voltage_ = 0.0F;
  float current_ = 0.0F;
  float voltage_factor_ = 1.0F;
  float current_factor_ = 1.0F;
  float voltage_lpf_ = 0.0F;
  float current_lpf_ = 0.0F;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
