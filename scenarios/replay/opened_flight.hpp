#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/replay/magnetic_field.hpp"
#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/replay/recorded_flight.hpp"

namespace ironbird::scenarios {

/// What the command line says of the flight itself.
struct FlightChoice {
  Px4Choice px4;               ///< of a log of PX4
  std::filesystem::path data;  ///< folder of a column map's tables; empty: the map's own
  std::vector<std::pair<std::string, std::string>> map_settings;  ///< paths and texts laid over a column map
};

/// A flight that is to be replayed, whoever recorded it.
struct OpenedFlight {
  RecordedFlight flight;
  std::vector<std::string> sensors;    ///< what is to be told of its sensors, a line each
  bool simulated = false;              ///< no vehicle flew
  std::optional<int> mag;              ///< instance that was taken; none: it has no number, or there is none
  std::string mag_source;              ///< why that one
  double gnss_delay = 0.0;             ///< s
  std::string gnss_delay_source;       ///< who says so
  std::optional<MagneticField> field;  ///< of the earth where it flew; none: no place is told
  bool dated = true;                   ///< the field is that of the day it flew, not of the newest model
};

/// Reads a flight by the kind of its file: a column map (`.toml`) with the tables that it names, else a log
/// of PX4. @throws UserError, for a column map ConfigError, naming the file and what is wrong
OpenedFlight open_flight(const std::filesystem::path& file, const FlightChoice& choice);

}  // namespace ironbird::scenarios
