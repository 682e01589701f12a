#pragma once

#include <array>
#include <cstdint>

#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/error_model.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/sensors/timing.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

struct GnssParams {
  TimingParams timing{.rate = 10.0};
  Vector3 p_BA_B = Vector3::Zero();
  ScalarErrorParams<LengthUnits> horizontal;
  ScalarErrorParams<LengthUnits> vertical;
  ScalarErrorParams<SpeedUnits> velocity;
  double horizontal_accuracy = 1.5;
  double vertical_accuracy = 2.5;
  double speed_accuracy = 0.1;
  int fix = 3;
  int satellites = 15;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("timing", self.timing, "", "when it samples");
    visit("p_BA_B", self.p_BA_B, "m", "position of the antenna from the centre of mass", -10.0, 10.0);
    visit("horizontal", self.horizontal, "", "errors of the position to the north and to the east, each");
    visit("vertical", self.vertical, "", "errors of the altitude");
    visit("velocity", self.velocity, "", "errors of the velocity, each axis of N");
    visit("horizontal_accuracy", self.horizontal_accuracy, "m", "what the receiver claims", 0.0, 1e3);
    visit("vertical_accuracy", self.vertical_accuracy, "m", "what the receiver claims", 0.0, 1e3);
    visit("speed_accuracy", self.speed_accuracy, "m/s", "what the receiver claims", 0.0, 1e2);
    visit("fix", self.fix, "1", "0 none, 3 three-dimensional, 6 and 7 RTK float and fixed", 0.0, 7.0);
    visit("satellites", self.satellites, "1", "in use", 0.0, 100.0);
  }
};

/// Satellite receiver: position and velocity of its antenna. The earth is a sphere of kEarthRadius around the
/// local origin's meridian and parallel. Claimed accuracies are constants; they do not follow the errors.
class Gnss {
 public:
  using Reading = GnssReading;

  Gnss(const GnssParams& params, const SensorSite& site, double period, std::uint64_t seed);

  /// The reading at `now`.
  GnssReading measure(const Truth& truth, Time now, const FaultState& faults, bool armed);

 private:
  GnssParams params_;
  SensorSite site_;
  double parallel_radius_;
  ScalarError north_;
  ScalarError east_;
  ScalarError altitude_;
  std::array<ScalarError, 3> velocity_;
};

}  // namespace ironbird::simulator
