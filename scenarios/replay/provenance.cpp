#include "scenarios/replay/provenance.hpp"

#include "scenarios/bench/run_time.hpp"

namespace ironbird::scenarios {

ReplayedFlight provenance_of(const RecordedFlight& flight) {
  ReplayedFlight told;
  told.recorder = flight.what;
  if (!flight.estimates.empty()) told.compared_with = flight.estimates.front().name;
  return told;
}

void note_window(ReplayedFlight& told, const RecordedFlight& flight, const Interval& window, bool named) {
  told.window_begin = to_seconds(window.begin);
  told.window_end = to_seconds(window.end);
  const bool whole = window.begin == hil_bridge::Time::zero() && window.end == flight.end;
  told.window_source = named   ? "as named"
                       : whole ? "the whole log"
                               : "the flight without take-off and landing";
}

}  // namespace ironbird::scenarios
