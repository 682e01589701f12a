#include "scenarios/replay/provenance.hpp"

#include "scenarios/bench/run_time.hpp"

namespace ironbird::scenarios {

ReplayedFlight provenance_of(const Px4Flight& px4, const std::filesystem::path& file, double declination,
                             const std::string& declination_source, const Interval& window, bool named) {
  ReplayedFlight told;
  told.file = file.filename().string();
  told.recorder = px4.flight.what;
  if (!px4.flight.estimates.empty()) told.compared_with = px4.flight.estimates.front().name;
  told.simulated = px4.simulated;
  told.magnetometer = px4.mag;
  told.magnetometer_source = px4.mag_source;
  told.declination = declination;
  told.declination_source = declination_source;
  told.gnss_delay = px4.gnss_delay;
  told.gnss_delay_source = px4.gnss_delay_source;
  told.window_begin = to_seconds(window.begin);
  told.window_end = to_seconds(window.end);
  const bool whole = window.begin == hil_bridge::Time::zero() && window.end == px4.flight.end;
  told.window_source = named   ? "as named"
                       : whole ? "the whole log"
                               : "the flight without take-off and landing";
  return told;
}

}  // namespace ironbird::scenarios
