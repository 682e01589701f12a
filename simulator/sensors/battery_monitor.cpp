#include "simulator/sensors/battery_monitor.hpp"

namespace ironbird::simulator {

BatteryMonitor::BatteryMonitor(const BatteryMonitorParams& params, const SensorSite& /*site*/, double period,
                               std::uint64_t seed)
    : fixed_voltage_(params.fixed_voltage),
      fixed_current_(params.fixed_current),
      voltage_(params.voltage, period, seed, "sensors/battery/voltage"),
      current_(params.current, period, seed, "sensors/battery/current") {}

BatteryReading BatteryMonitor::measure(const Truth& truth, Time now, const FaultState& /*faults*/,
                                       bool /*armed*/) {
  BatteryReading reading;
  reading.taken = now;
  reading.voltage = voltage_.apply(fixed_voltage_.value_or(truth.battery_voltage));
  reading.current = current_.apply(fixed_current_.value_or(truth.battery_current));
  return reading;
}

}  // namespace ironbird::simulator
