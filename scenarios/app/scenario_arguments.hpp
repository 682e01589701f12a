#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ironbird::scenarios {

class VerbOptions;

/// Which scenarios, and how changed: what `run` and `check` take.
struct ScenarioArguments {
  std::vector<std::string> files;
  std::vector<std::string> settings;
  std::optional<std::string> seeds;
};

void add_scenario_arguments(VerbOptions& options, ScenarioArguments& arguments);

/// Path and text of each `--set`. @throws ConfigError for one that is not path=value
std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& settings);

/// The seeds that "7" or "1:20" means.
/// @param asked  absent: nothing was asked for  @return none then: the scenario's own seed flies
/// @throws ConfigError for what means none, and for too many
std::vector<std::uint64_t> parse_seeds(const std::optional<std::string>& asked);

}  // namespace ironbird::scenarios
