#pragma once

#include <cstdint>

#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/error_model.hpp"
#include "simulator/sensors/mounting.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/sensors/timing.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

struct MagnetometerParams {
  TimingParams timing{.rate = 100.0};
  MountingParams mounting;
  Vector3 hard_iron_B = Vector3::Zero();
  Matrix3 soft_iron = Matrix3::Identity();
  Vector3 current_coupling_B = Vector3::Zero();
  VectorErrorParams<MagneticFieldUnits> error;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("timing", self.timing, "", "when it samples");
    visit("mounting", self.mounting, "", "where it sits; the position does not matter");
    visit("hard_iron_B", self.hard_iron_B, "T", "field of the vehicle's own magnets", -1e-2, 1e-2);
    visit("soft_iron", self.soft_iron, "1", "what the vehicle's iron makes of the earth's field, in B", -10.0,
          10.0);
    visit("current_coupling_B", self.current_coupling_B, "T/A", "field per battery current", -1e-3, 1e-3);
    visit("error", self.error, "", "errors of the chip");
  }
};

/// Magnetic field at the sensor: m_B = soft_iron R_NB^T m_N + hard_iron + current_coupling i, in the sensor's
/// axes, with the chip's errors. Nothing is calibrated away: give what is left after the FCU's calibration.
class Magnetometer {
 public:
  using Reading = MagReading;

  Magnetometer(const MagnetometerParams& params, const SensorSite& site, double period, std::uint64_t seed);

  /// The reading at `now`.
  MagReading measure(const Truth& truth, Time now, const FaultState& faults, bool armed);

 private:
  MagnetometerParams params_;
  Matrix3 R_SB_;
  Vector3 m_N_;
  VectorError error_;
};

}  // namespace ironbird::simulator
