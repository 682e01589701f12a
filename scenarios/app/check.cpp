#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/failure.hpp"
#include "scenarios/bench/bench.hpp"

namespace ironbird::scenarios {

namespace {

int check(const std::vector<std::string>& files, const autopilot::Modules& modules) {
  int code = kExitPass;
  for (const std::string& file : files) {
    try {
      const LoadedScenario loaded = load_scenario(file, {}, modules);
      try {
        const Bench bench(loaded, modules, {});
      } catch (const std::invalid_argument& error) {
        throw loaded.located(error);
      }
      std::fprintf(stderr, "%s: no finding\n", file.c_str());
    } catch (const std::exception& error) {
      const Failure failure = failure_of(error);
      std::fprintf(stderr, "%s\n", failure.text.c_str());
      code = std::max(code, failure.exit_code);
    }
  }
  return code;
}

}  // namespace

Verb check_verb() {
  return {"check", "validate scenarios without flying them", [](CLI::App& app) {
            auto files = std::make_shared<std::vector<std::string>>();
            app.add_option("scenarios", *files, "scenario files")->required();
            app.footer("Example:\n  ironbird check scenarios/library/*/*.toml");
            return [files](const autopilot::Modules& modules) { return check(*files, modules); };
          }};
}

}  // namespace ironbird::scenarios
