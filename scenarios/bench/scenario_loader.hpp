#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "scenarios/bench/scenario.hpp"
#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {

/// What the command line changes in a scenario.
struct Overrides {
  std::vector<std::pair<std::string, std::string>> settings;  ///< path and text of each `--set`
  std::optional<std::uint64_t> seed;
};

/// Parameters of the autopilot that differ from their defaults, for one slot and one kind of module.
struct ModuleSettings {
  std::string slot;
  std::string kind;
  std::vector<autopilot::ParameterSetting> values;  ///< path in the parameter table
};

/// A scenario with everything that it refers to, read and checked.
struct LoadedScenario {
  std::filesystem::path file;
  std::filesystem::path vehicle_path;                ///< the vehicle's folder
  std::filesystem::path field_path;                  ///< the field's file; empty when it is not found
  std::vector<std::filesystem::path> field_folders;  ///< in which it was looked for
  std::string name;                                  ///< of the file, without its ending
  Scenario scenario;
  autopilot::AutopilotConfig autopilot;
  std::vector<ModuleSettings> modules;
  std::string effective_config;                            ///< the whole configuration as TOML
  std::string digest;                                      ///< SHA-256 of it
  std::map<std::string, std::string, std::less<>> places;  ///< path of each value to file:line:column

  /// The settings for a module of this kind in this slot.
  const ModuleSettings* settings_of(const std::string& slot, const std::string& kind) const;

  /// Do the files, or the command line, give this path a value? For example `event[2].lasts`.
  bool gives(const std::string& path) const { return places.contains(path); }

  /// A finding with the place in the files that it is about in front, as far as its first words are a path of
  /// the configuration; else with the beginning of the scenario's file.
  std::string located(const std::string& finding) const;
  ConfigError located(const std::invalid_argument& error) const { return ConfigError(located(error.what())); }

  /// Of a table or value that was read at `place`: where the scenario itself changes a value in it, when it
  /// does.
  std::string own_place(const std::string& path, const std::string& place) const;
};

/// Reads a scenario, its includes and its vehicle's files, and checks everything that can be checked without
/// making the objects of a run.
/// @param modules  the kinds that `[autopilot]` can name
/// @throws ConfigError with one line for each finding
LoadedScenario load_scenario(const std::filesystem::path& file, const Overrides& overrides,
                             const autopilot::Modules& modules);

/// The scenario of a flight that was flown, out of the configuration in its log: only what an autopilot needs
/// is checked, for the world is not made anew; what pictures need is looked for and need not be there.
/// @param log            its file, for names and messages
/// @param configuration  as `effective_config`; the same one comes out when nothing is overridden
/// @throws ConfigError with one line for each finding
LoadedScenario load_flown(const std::filesystem::path& log, const std::string& configuration,
                          const Overrides& overrides, const autopilot::Modules& modules);

}  // namespace ironbird::scenarios
