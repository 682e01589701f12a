#pragma once

#include <filesystem>
#include <string>

#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/requirements/replayed_flight.hpp"

namespace ironbird::scenarios {

/// What a replay's verdict tells of the log, and of what was chosen from it.
/// @param declination  rad
/// @param window  what was compared. @param named  somebody named it
ReplayedFlight provenance_of(const Px4Flight& px4, const std::filesystem::path& file, double declination,
                             const std::string& declination_source, const Interval& window, bool named);

}  // namespace ironbird::scenarios
