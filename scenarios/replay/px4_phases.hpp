#pragma once

#include <vector>

#include "scenarios/replay/px4_records.hpp"
#include "scenarios/replay/recorded_flight.hpp"

namespace ironbird::scenarios {

/// What PX4 was doing while the IMU was logged: armed and mode by vehicle_status, airborne by its land
/// detector. The first begins with the first sample of the IMU. Empty when the log has neither topic.
std::vector<RecordedPhase> read_px4_phases(const Px4Log& log);

}  // namespace ironbird::scenarios
