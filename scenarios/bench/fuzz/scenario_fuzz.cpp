// Any text as a scenario: it is refused, in single lines each of which names a place, or it is loaded; and
// loaded again it is the same.

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "ci/fuzzing/harness.hpp"
#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::fuzzing {

namespace {

using scenarios::ConfigError;
using scenarios::LoadedScenario;

std::size_t digits(std::string_view text) {
  return std::min(text.find_first_not_of("0123456789"), text.size());
}

/// Does it begin like `file:line:column: `?
bool is_placed(std::string_view finding) {
  for (std::size_t at = finding.find(':'); at != std::string_view::npos; at = finding.find(':', at + 1)) {
    std::string_view rest = finding.substr(at + 1);
    const std::size_t line = digits(rest);
    if (line == 0 || rest.substr(line, 1) != ":") continue;
    rest = rest.substr(line + 1);
    const std::size_t column = digits(rest);
    if (column > 0 && rest.substr(column).starts_with(": ")) return true;
  }
  return false;
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  static const bool at_home = chdir(IRONBIRD_SOURCE_DIR) == 0;
  require(at_home, "the tree is there");
  static const autopilot::Modules modules = autopilot::standard_modules();
  static const MemoryFile file;
  file.write(input);
  try {
    const LoadedScenario loaded = scenarios::load_scenario(file.path(), {}, modules);
    const LoadedScenario again = scenarios::load_scenario(file.path(), {}, modules);
    require(loaded.digest == again.digest && loaded.effective_config == again.effective_config,
            "a scenario that is loaded again is the same");
  } catch (const ConfigError& error) {
    require(!error.findings().empty(), "who refuses says why");
    for (const std::string& finding : error.findings()) {
      require(finding.find('\n') == std::string::npos, "a finding is one line: " + finding);
      require(is_placed(finding) || finding.ends_with(" findings more"),
              "a finding names a place: " + finding);
    }
  }
}

}  // namespace ironbird::fuzzing
