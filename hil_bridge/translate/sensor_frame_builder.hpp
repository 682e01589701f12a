#pragma once

#include <optional>

#include "autopilot/types/sensor_frame.hpp"
#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// Gathers the FCU's messages into the autopilot's sensor frames: one frame for each IMU message, with the
/// slower sensors that arrived since the frame before. A slower sensor that says what is not finite says
/// nothing.
///
/// Stamps: the wire carries those of the IMU and of GNSS. Magnetometer and barometer have none and get the
/// stamp of the latest IMU message: a real loss of information, which the simulated link shares. The status
/// gets the time of its arrival; it comes again when the FCU tells how its motors are driven.
class SensorFrameBuilder {
 public:
  /// Takes one message. @return a frame when the message was an IMU sample; valid until the next call
  const autopilot::SensorFrame* push(const Arrival& arrival);

 private:
  void take(const rosflight::SmallMag& message);
  void take(const rosflight::SmallBaro& message);
  void take(const rosflight::RosflightGnss& message);
  void take(const rosflight::RosflightStatus& message, Time when);
  void take(const rosflight::RosflightOutputRaw& message, Time when);

  autopilot::SensorFrame gathering_;
  autopilot::SensorFrame complete_;
  Time imu_stamp_{0};
  std::optional<autopilot::FcuStatus> status_;
  std::optional<double> greatest_output_;
  Time output_stamp_{0};
  double battery_voltage_ = 0.0;
};

}  // namespace ironbird::hil_bridge
