#pragma once

#include <optional>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/replay/px4_records.hpp"

namespace ironbird::scenarios {

/// Fixes, and what they tell of place and date. Sets `first_fix`, `unix_time` and `gnss_delay` of the flight.
std::vector<hil_bridge::Arrival> read_px4_gnss(Px4Log& log, std::optional<double> delay, Px4Flight& flight);

/// Samples of the magnetometer that is named, or fits the earth's field at the first fix best. Sets `mags`
/// and `mag`.
/// @throws UserError when there is none of that number
std::vector<hil_bridge::Arrival> read_px4_mag(Px4Log& log, std::optional<int> named, Px4Flight& flight);

/// Samples of the barometer, whichever layout it has.
std::vector<hil_bridge::Arrival> read_px4_baro(Px4Log& log);

}  // namespace ironbird::scenarios
