#include "scenarios/app/scenario_arguments.hpp"

#include <charconv>
#include <numeric>
#include <string_view>

#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/scenario.hpp"
#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::uint64_t kMostSeeds = 10'000;

std::uint64_t parse_seed(std::string_view number, const std::string& text) {
  std::uint64_t seed = 0;
  const auto read = std::from_chars(number.data(), number.data() + number.size(), seed);
  if (read.ec == std::errc::result_out_of_range || (read.ec == std::errc() && seed > kGreatestSeed))
    throw ConfigError("--seed " + text + ": must be at most " + std::to_string(kGreatestSeed));
  if (read.ec != std::errc() || read.ptr != number.data() + number.size())
    throw ConfigError("--seed " + text + ": must be a whole number >= 0, or first:last such as 1:20");
  return seed;
}

}  // namespace

void add_scenario_arguments(VerbOptions& options, ScenarioArguments& arguments) {
  options.option("scenarios", arguments.files, "scenario files").required();
  options.option("--set", arguments.settings, "changes the scenario; may be repeated")
      .one_word_each()
      .called("PATH=VALUE");
  options.option("--seed", arguments.seeds,
                 "seed of the run, or first:last for several runs; at most " + std::to_string(kGreatestSeed));
}

std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& settings) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError("--set " + setting + ": must be path=value, for example plant.engine=ode");
    }
    pairs.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  return pairs;
}

std::vector<std::uint64_t> parse_seeds(const std::optional<std::string>& asked) {
  if (!asked) return {};
  const std::string& text = *asked;
  const std::string_view all = text;
  const std::size_t colon = all.find(':');
  const std::uint64_t first = parse_seed(all.substr(0, colon), text);
  const std::uint64_t last =
      colon == std::string_view::npos ? first : parse_seed(all.substr(colon + 1), text);
  if (last < first) throw ConfigError("--seed " + text + ": runs backwards; the lower seed comes first");
  if (last - first >= kMostSeeds)
    throw ConfigError("--seed " + text + ": must be at most " + std::to_string(kMostSeeds) + " seeds");
  std::vector<std::uint64_t> seeds(last - first + 1);
  std::iota(seeds.begin(), seeds.end(), first);
  return seeds;
}

}  // namespace ironbird::scenarios
