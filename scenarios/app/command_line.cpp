#include "scenarios/app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/reproducible_math.hpp"
#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kVersion = IRONBIRD_VERSION;

/// A configuration error has its place in its text; anything else is told with the program's name.
int report(const std::exception& error, int code) {
  std::fprintf(stderr, "%s\n", error.what());
  return code;
}

}  // namespace

int run_command_line(int argc, char** argv, const autopilot::Modules& modules) {
  CLI::App app{"Ironbird: a hardware-in-the-loop bench for multirotor autopilots"};
  app.require_subcommand(1);
  app.set_version_flag(
      "--version", std::string("ironbird ") + kVersion + ", elementary functions: " + reproducible_math());
  app.footer(
      "Exit codes: 0 all checks hold, 1 a check failed, 2 usage or configuration, 4 internal error,\n"
      "5 inconclusive or invalid, 130 interrupted.\n"
      "Start with: ironbird run scenarios/library/paper/three_waypoints.toml");
  const std::array<Verb, 3> verbs = {run_verb(), check_verb(), topics_verb()};
  std::function<int(const autopilot::Modules&)> chosen;
  for (const Verb& verb : verbs) {
    CLI::App* command = app.add_subcommand(verb.name, verb.summary);
    command->callback([&chosen, work = verb.declare(*command)] { chosen = work; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? kExitPass : kExitUsage;
  }
  try {
    return chosen(modules);
  } catch (const ConfigError& error) {
    return report(error, kExitUsage);
  } catch (const std::invalid_argument& error) {
    return report(error, kExitUsage);
  } catch (const std::runtime_error& error) {
    return report(error, kExitUsage);
  } catch (const std::exception& error) {
    return report(error, kExitInternal);
  }
}

}  // namespace ironbird::scenarios
