#pragma once

#include <array>
#include <cstdint>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// The latest of each message that tells how the FCU itself is doing: for the log, the checks and the
/// operator's eyes.
struct Telemetry {
  rosflight::RosflightStatus status;
  rosflight::RosflightOutputRaw output_raw;
  rosflight::AttitudeQuaternion attitude;
  rosflight::RcChannels rc;
  rosflight::RosflightBatteryStatus battery;

  /// Takes one message; messages of other kinds are passed over.
  void take(const rosflight::Message& message);

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("status", self.status, "", "state of the FCU");
    visit("output_raw", self.output_raw, "", "what the outputs are driven with");
    visit("attitude", self.attitude, "", "the FCU's own attitude filter");
    visit("rc", self.rc, "", "the pilot's sticks and switches");
    visit("battery", self.battery, "", "battery monitor");
  }
};

}  // namespace ironbird::hil_bridge
