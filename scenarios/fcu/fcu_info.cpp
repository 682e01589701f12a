#include <cstdio>
#include <memory>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/fcu/fcu_verb.hpp"
#include "scenarios/fcu/unit_line.hpp"
#include "scenarios/fcu/unit_report.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kInfoListening = 2.2;  // s; rates are counted over a whole second

struct InfoArguments {
  UnitAddress address;
  bool json = false;
};

int info(const InfoArguments& arguments) {
  note_interrupts();
  UnitOnLine unit(arguments.address, UnitOnLine::Talk::kQuestions);
  unit.meet();
  unit.until(kInfoListening, [] { return false; });
  if (interrupt_requested()) return kExitInterrupted;
  const auto report = arguments.json ? unit_report_json : unit_report;
  std::fputs(report(unit.fcu(), unit.name(), unit.now()).c_str(), stdout);
  return kExitPass;
}

}  // namespace

FcuWork declare_fcu_info(VerbOptions& options) {
  auto arguments = std::make_shared<InfoArguments>();
  add_unit_address(options, arguments->address);
  options.flag("--json", arguments->json, "for programs");
  options.footer(
      "Only asks and listens, for some seconds.\nExample:\n  ironbird fcu info --port /dev/ttyACM0");
  return [arguments](const autopilot::Modules&) { return info(*arguments); };
}

}  // namespace ironbird::scenarios
