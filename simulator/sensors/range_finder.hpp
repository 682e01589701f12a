#pragma once

#include <cstdint>

#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/error_model.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/sensors/timing.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

struct RangeFinderParams {
  TimingParams timing{.enabled = false, .rate = 20.0};
  Vector3 p_BS_B = Vector3::Zero();
  double minimum = 0.1;
  double maximum = 8.0;
  bool slant = true;
  ScalarErrorParams<LengthUnits> error;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("timing", self.timing, "", "when it samples");
    visit("p_BS_B", self.p_BS_B, "m", "position from the centre of mass", -10.0, 10.0);
    visit("minimum", self.minimum, "m", "nearest distance it can tell", 0.0, 1e3);
    visit("maximum", self.maximum, "m", "farthest distance it can tell", 0.0, 1e4);
    visit("slant", self.slant, "1",
          "distance along Bz; false: height of the sensor, as the reference simulator");
    visit("error", self.error, "", "errors of the chip");
  }
};

/// Distance to flat ground at Nz = 0 along +Bz. Outside its limits it reads the limit, without noise. It does
/// not see obstacles.
class RangeFinder {
 public:
  using Reading = RangeReading;

  RangeFinder(const RangeFinderParams& params, const SensorSite& site, double period, std::uint64_t seed);

  /// The reading at `now`.
  RangeReading measure(const Truth& truth, Time now, const FaultState& faults, bool armed);

 private:
  double distance(const Truth& truth) const;

  RangeFinderParams params_;
  ScalarError error_;
};

}  // namespace ironbird::simulator
