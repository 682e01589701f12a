#include <cstdio>
#include <memory>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/make_guard.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/fcu/fcu_verb.hpp"
#include "scenarios/fcu/preflight.hpp"
#include "scenarios/fcu/unit_line.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kPreflightListening =
    3.2;  // s; a battery speaks ten times a second, rates are counted over a whole one

struct PreflightArguments {
  UnitAddress address;
  std::string scenario;
  bool json = false;
};

PreflightWishes wishes_of(const std::string& file, const autopilot::Modules& modules) {
  PreflightWishes wishes;
  if (file.empty()) return wishes;
  const LoadedScenario loaded = load_scenario(file, {}, modules);
  wishes.scenario = file;
  wishes.parameters = wanted_parameters(loaded.scenario);
  wishes.imu_rate = 1.0 / to_seconds(loaded.scenario.fcu.tick);
  return wishes;
}

int look(const PreflightArguments& arguments, const autopilot::Modules& modules) {
  note_interrupts();
  const PreflightWishes wishes = wishes_of(arguments.scenario, modules);
  UnitOnLine unit(arguments.address, UnitOnLine::Talk::kQuestions);
  UnitView view;
  unit.listen([&view](const hil_bridge::Arrival& arrival) { view.take(arrival); });
  const hil_bridge::Time began = unit.now();
  unit.meet();
  unit.until(kPreflightListening, [] { return false; });
  if (interrupt_requested()) return kExitInterrupted;
  const Monitored seen{unit.fcu(), view, unit.name(), unit.line_up(), unit.now(), began};
  const std::vector<PreflightItem> items = preflight(seen, wishes);
  const bool colour = Terminal::of_standard_output().colour;
  std::fputs((arguments.json ? preflight_json(items) : preflight_text(items, colour)).c_str(), stdout);
  return all_green(items) ? kExitPass : kExitFail;
}

}  // namespace

FcuWork declare_fcu_preflight(VerbOptions& options) {
  auto arguments = std::make_shared<PreflightArguments>();
  add_unit_address(options, arguments->address);
  options.option("scenario", arguments->scenario,
                 "whose parameters the unit must have; without one they are not compared");
  options.flag("--json", arguments->json, "for programs");
  options.footer(
      "Only asks and listens, for some seconds; the vehicle stands still meanwhile. Exit code 0 when nothing "
      "is "
      "red, 1 when\n"
      "something is, 3 without a link. A green list is no permission to fly: docs/safety.md has the rest.\n"
      "Examples:\n"
      "  ironbird fcu preflight --port /dev/ttyACM0 scenarios/library/paper/three_waypoints.toml\n"
      "  ironbird fcu preflight --port /dev/ttyACM0 --json");
  return [arguments](const autopilot::Modules& modules) { return look(*arguments, modules); };
}

}  // namespace ironbird::scenarios
