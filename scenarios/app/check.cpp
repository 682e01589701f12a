#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/failure.hpp"
#include "scenarios/app/scene.hpp"
#include "scenarios/bench/bench.hpp"

namespace ironbird::scenarios {

namespace {

/// What is wrong with one file: what loading finds, then what making the objects of a run finds, then what
/// drawing it would.
Failure failure_in(const std::string& file, const autopilot::Modules& modules, std::size_t& count) {
  try {
    const LoadedScenario loaded = load_scenario(file, {}, modules);
    try {
      const Bench bench(loaded, modules, {});
      if (has_scene(loaded)) check_scene(loaded);
    } catch (const std::invalid_argument& error) {
      throw loaded.located(error);
    }
    return {kExitPass, file + ": no finding"};
  } catch (const ConfigError& error) {
    count += error.findings().size();
    return failure_of(error);
  } catch (const std::exception& error) {
    ++count;
    return failure_of(error);
  }
}

int check(const std::vector<std::string>& files, const autopilot::Modules& modules) {
  std::size_t count = 0, wrong = 0;
  int code = kExitPass;
  for (const std::string& file : files) {
    const Failure failure = failure_in(file, modules, count);
    std::fprintf(stderr, "%s\n", failure.text.c_str());
    code = std::max(code, failure.exit_code);
    wrong += failure.exit_code == kExitPass ? 0 : 1;
  }
  if (count > 1 || (count > 0 && files.size() > 1)) {
    std::fprintf(stderr, "%zu finding%s in %zu of %zu file%s\n", count, count == 1 ? "" : "s", wrong,
                 files.size(), files.size() == 1 ? "" : "s");
  }
  return code;
}

}  // namespace

Verb check_verb() {
  return {"check", "validate scenarios without flying them", [](CLI::App& app) {
            auto files = std::make_shared<std::vector<std::string>>();
            app.add_option("scenarios", *files, "scenario files")->required();
            app.footer(
                "Tells every finding of every file in a line of its own, `file:line:column: path = value:\n"
                "what is wrong, what is allowed`, and ends with 2 when there is any.\n"
                "Examples:\n"
                "  ironbird check scenarios/library/paper/three_waypoints.toml\n"
                "  ironbird check scenarios/library/*/*.toml");
            return [files](const autopilot::Modules& modules) { return check(*files, modules); };
          }};
}

}  // namespace ironbird::scenarios
