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
  const bool to_the_end = window.end == flight.end;
  const bool whole = to_the_end && window.begin == hil_bridge::Time::zero();
  told.window_source = named        ? "as named"
                       : whole      ? "the whole log"
                       : to_the_end ? "the log from where it was begun"
                                    : "the flight without take-off and landing";
}

}  // namespace ironbird::scenarios
