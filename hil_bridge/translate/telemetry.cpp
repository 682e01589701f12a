#include "hil_bridge/translate/telemetry.hpp"

namespace ironbird::hil_bridge {

void Telemetry::take(const rosflight::Message& message) {
  if (const auto* attitude_now = std::get_if<rosflight::AttitudeQuaternion>(&message)) {
    attitude = *attitude_now;
  } else if (const auto* outputs = std::get_if<rosflight::RosflightOutputRaw>(&message)) {
    output_raw = *outputs;
  } else if (const auto* status_now = std::get_if<rosflight::RosflightStatus>(&message)) {
    status = *status_now;
  } else if (const auto* channels = std::get_if<rosflight::RcChannels>(&message)) {
    rc = *channels;
  } else if (const auto* battery_now = std::get_if<rosflight::RosflightBatteryStatus>(&message)) {
    battery = *battery_now;
  }
}

}  // namespace ironbird::hil_bridge
