#pragma once

#include <cstdint>
#include <optional>

#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/error_model.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/sensors/timing.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

struct BatteryMonitorParams {
  TimingParams timing{.rate = 10.0};
  std::optional<double> fixed_voltage;
  std::optional<double> fixed_current;
  ScalarErrorParams<VoltageUnits> voltage;
  ScalarErrorParams<CurrentUnits> current;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("timing", self.timing, "", "when it samples");
    visit("fixed_voltage", self.fixed_voltage, "V",
          "read instead of the battery's voltage, as the reference simulator", 0.0, 1e3);
    visit("fixed_current", self.fixed_current, "A",
          "read instead of the battery's current, as the reference simulator", 0.0, 1e4);
    visit("voltage", self.voltage, "", "errors of the voltage");
    visit("current", self.current, "", "errors of the current");
  }
};

/// Terminal voltage and current of the battery.
class BatteryMonitor {
 public:
  using Reading = BatteryReading;

  BatteryMonitor(const BatteryMonitorParams& params, const SensorSite& site, double period,
                 std::uint64_t seed);

  /// The reading at `now`.
  BatteryReading measure(const Truth& truth, Time now, const FaultState& faults, bool armed);

 private:
  std::optional<double> fixed_voltage_;
  std::optional<double> fixed_current_;
  ScalarError voltage_;
  ScalarError current_;
};

}  // namespace ironbird::simulator
