#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/replay/replay.hpp"
#include "scenarios/requirements/replayed_flight.hpp"

namespace ironbird::scenarios {

/// What the command line says of a flight that is to be replayed. No `describe`: CLI11 fills it.
struct FlightArguments {
  std::string flight;
  std::string data;          ///< folder of a column map's tables; empty: the map's own
  int mag = -1;              ///< instance; -1: not named
  std::string declination;   ///< deg; empty: not named
  double gnss_delay = -1.0;  ///< s; negative: not named
  double start = 0.0;        ///< s; what was recorded before is left out
};

/// A number that is all of a text; nothing when it is none, or not finite.
std::optional<double> number_of(const std::string& text);

/// Which autopilot stands in. No `describe`: neither of it is a value of a file.
struct PilotChoice {
  std::filesystem::path scenario;                             ///< empty: what is usual for the flight
  std::vector<std::pair<std::string, std::string>> settings;  ///< path and text
};

/// A recorded flight, whoever recorded it, and how it is replayed.
class ReplaySource {
 public:
  /// Reads what the command line names, by what it is. @throws UserError, ConfigError
  /// @param map_settings  paths and texts laid over a column map
  static std::unique_ptr<ReplaySource> open(
      const FlightArguments& arguments, const std::vector<std::pair<std::string, std::string>>& map_settings);
  virtual ~ReplaySource() = default;

  virtual const RecordedFlight& flight() const = 0;
  /// @throws ConfigError
  virtual LoadedScenario load(const PilotChoice& choice, const autopilot::Modules& modules) const = 0;
  virtual ReplayResult replay(const LoadedScenario& loaded, const autopilot::Modules& modules,
                              ReplayOptions options) const = 0;
  /// What a reader of the figures has to know of it; what was compared is not yet in it.
  virtual ReplayedFlight provenance() const = 0;
  /// What people should know of it, a line each.
  virtual std::vector<std::string> about() const = 0;
};

}  // namespace ironbird::scenarios
