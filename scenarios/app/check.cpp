#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/failure.hpp"
#include "scenarios/app/scenario_arguments.hpp"
#include "scenarios/app/scene.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/video/video_sink.hpp"

namespace ironbird::scenarios {

namespace {

struct CheckArguments {
  ScenarioArguments scenarios;
  bool video = false;
  bool snapshots = false;
};

/// What is wrong with one file: what loading finds, then what making the objects of a run finds, unless they
/// need a unit elsewhere, then what drawing it would.
Failure failure_in(const std::string& file, const Overrides& overrides, bool pictures,
                   const autopilot::Modules& modules, std::size_t& count) {
  try {
    const LoadedScenario loaded = load_scenario(file, overrides, modules);
    try {
      if (loaded.scenario.fcu.has_own_unit()) const Bench possible(loaded, modules, {});
      if (pictures || has_scene(loaded)) check_scene(loaded);
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

int check(const CheckArguments& arguments, const autopilot::Modules& modules) {
  if (arguments.video) check_encoder();
  const std::vector<std::string>& files = arguments.scenarios.files;
  Overrides overrides{split_settings(arguments.scenarios.settings), std::nullopt};
  // What a scenario's objects are does not depend on the seed.
  if (const auto seeds = parse_seeds(arguments.scenarios.seeds); !seeds.empty())
    overrides.seed = seeds.front();
  std::size_t count = 0, wrong = 0;
  int code = kExitPass;
  for (const std::string& file : files) {
    const bool pictures = arguments.video || arguments.snapshots;
    const Failure failure = failure_in(file, overrides, pictures, modules, count);
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
  return {"check", "validate scenarios without flying them", [](VerbOptions& options) {
            auto arguments = std::make_shared<CheckArguments>();
            add_scenario_arguments(options, arguments->scenarios);
            options.flag("--video", arguments->video,
                         "it is to be filmed: a vehicle without a scene is a finding, as is no encoder");
            options.flag("--snapshots", arguments->snapshots,
                         "it is to be drawn: a vehicle without a scene is a finding");
            options.footer(
                "Tells every finding of every file in a line of its own, `file:line:column: path = value:\n"
                "what is wrong, what is allowed`, and ends with 2 when there is any.\n"
                "Everything that can be known before the flight, pictures included: missing meshes too.\n"
                "Examples:\n"
                "  ironbird check scenarios/library/paper/three_waypoints.toml --set plant.engine=ode\n"
                "  ironbird check scenarios/library/*/*.toml");
            return [arguments](const autopilot::Modules& modules) { return check(*arguments, modules); };
          }};
}

}  // namespace ironbird::scenarios
