#pragma once

#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "scenarios/replay/px4_records.hpp"

namespace ironbird::scenarios {

/// The samples of the IMU as a unit's messages, in the order of time. Sets where the log begins and ends.
///
/// Samples whose stamps the others do not share are passed over; where the autopilot's clock stepped back for
/// good the log ends. Samples that the logger left out are put in (imu_gaps.hpp): a turn that went on
/// meanwhile must not be lost.
/// @throws UserError naming the file when it has none
std::vector<hil_bridge::Arrival> read_px4_imu(Px4Log& log);

}  // namespace ironbird::scenarios
