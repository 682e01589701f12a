#pragma once

#include "scenarios/replay/recorded_flight.hpp"
#include "scenarios/requirements/replayed_flight.hpp"

namespace ironbird::scenarios {

/// What a reader of the figures has to know of a flight, whoever recorded it.
ReplayedFlight provenance_of(const RecordedFlight& flight);

/// Notes what was compared. @param named  by whoever asked
void note_window(ReplayedFlight& told, const RecordedFlight& flight, const Interval& window, bool named);

}  // namespace ironbird::scenarios
