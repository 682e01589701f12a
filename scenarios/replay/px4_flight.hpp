#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/replay/magnetic_field.hpp"
#include "scenarios/replay/recorded_flight.hpp"
#include "scenarios/replay/ulog_file.hpp"

namespace ironbird::scenarios {

/// What is to be taken from a log of which there is more than one, or which the log does not tell.
struct Px4Choice {
  std::optional<int> mag;
  std::optional<double> gnss_delay;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("mag", self.mag, "1",
          "instance of the magnetometer; none: the one that fits the earth's field best");
    visit("gnss_delay", self.gnss_delay, "s",
          "from measurement to arrival; none: what the log's parameters say");
  }
};

/// A magnetometer of a log, and how well it fits the field of the earth.
struct MagCandidate {
  int instance = 0;
  std::size_t samples = 0;
  double strength = 0.0;
  double spread = 0.0;
  double misfit = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("instance", self.instance, "1", "of vehicle_magnetometer");
    visit("samples", self.samples, "1", "that it has");
    visit("strength", self.strength, "T", "mean");
    visit("spread", self.spread, "1", "standard deviation of the strength, relative");
    visit("misfit", self.misfit, "1",
          "how far its strength is from the earth's, and how it spreads, relative; the least is taken");
  }
};

/// A flight out of a PX4 log, and what was chosen on the way.
struct Px4Flight {
  RecordedFlight flight;
  std::vector<MagCandidate> mags;   ///< by instance
  std::optional<int> mag;           ///< the one that was taken; none: there is none
  std::string mag_source;           ///< why that one
  double gnss_delay = 0.0;          ///< s
  std::string gnss_delay_source;    ///< who says so
  std::optional<double> unix_time;  ///< s, UTC, of the first fix that tells it
  std::optional<hil_bridge::rosflight::RosflightGnss> first_fix;  ///< that is of use
  bool simulated = false;                                         ///< no vehicle flew

  /// The earth's field at the first fix, which there must be, at its date; where no date is told, of the
  /// newest model.
  MagneticField field_there() const;
};

/// Takes sensors and estimates of PX4 1.8 to 1.15 out of a log: integer and double latitudes, both layouts of
/// the barometer, several magnetometers. @throws UserError naming the file when it has no IMU, or no such
/// magnetometer, or when the one that is named tells no field
Px4Flight read_px4_flight(const UlogFile& file, const std::string& name, const Px4Choice& choice = {});

}  // namespace ironbird::scenarios
