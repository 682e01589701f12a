#pragma once

#include <cstdint>

#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/error_model.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/sensors/timing.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

struct AirspeedParams {
  TimingParams timing{.enabled = false, .rate = 100.0};
  bool keeps_sign = true;
  double temperature = 300.15;
  ScalarErrorParams<PressureUnits> error;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("timing", self.timing, "", "when it samples");
    visit("keeps_sign", self.keeps_sign, "1",
          "air from behind gives negative pressure; false: positive, as the reference simulator");
    visit("temperature", self.temperature, "K", "of the chip", 200.0, 400.0);
    visit("error", self.error, "", "errors of the chip");
  }
};

/// Pitot tube along +Bx: differential pressure rho u^2 / 2. Source: Small Unmanned Aircraft, section 7.3.2.
class Airspeed {
 public:
  using Reading = AirspeedReading;

  Airspeed(const AirspeedParams& params, const SensorSite& site, double period, std::uint64_t seed);

  /// The reading at `now`.
  AirspeedReading measure(const Truth& truth, Time now, const FaultState& faults, bool armed);

 private:
  AirspeedParams params_;
  ScalarError error_;
};

}  // namespace ironbird::simulator
