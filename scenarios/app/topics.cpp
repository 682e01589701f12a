#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/hil_fcu/can_motors.hpp"
#include "hil_bridge/serial_fcu/link_statistics.hpp"
#include "hil_bridge/translate/telemetry.hpp"
#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/requirements/signal_table.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

namespace {

void print_signals() {
  const simulator::Truth truth;
  const autopilot::Signals signals;
  const hil_bridge::Telemetry telemetry;
  const hil_bridge::LinkHealth link;
  const hil_bridge::CanMotorsStatus can;
  SignalTable table;
  table.add("truth", truth);
  table.add("autopilot", signals);
  table.add("fcu", telemetry);
  table.add("link", link);
  table.add("can", can);
  std::puts("Signals: for checks, and topics of the log");
  for (const SignalLeaf& leaf : table.leaves()) {
    std::printf("  %-58s %-10s %s\n", leaf.path.c_str(), leaf.unit.c_str(), leaf.meaning.c_str());
  }
}

template <class Base>
void print_parameters(const char* slot, const autopilot::Registry<Base>& registry) {
  for (const std::string& kind : registry.names()) {
    autopilot::ParameterTable table;
    const std::unique_ptr<Base> module = registry.make(kind);
    module->register_parameters(table, std::string(slot) + "." + kind);
    for (const autopilot::ParameterSlot& parameter : table.slots()) {
      const double value =
          std::visit([](const auto* number) { return static_cast<double>(*number); }, parameter.value);
      std::printf("  %-58s %-10s %-12g", parameter.path.c_str(), parameter.unit.c_str(), value);
      if (std::isfinite(parameter.lower)) std::printf(" [%g, %g]", parameter.lower, parameter.upper);
      std::printf(" %s\n", parameter.description.c_str());
    }
  }
}

int topics(const autopilot::Modules& modules) {
  print_signals();
  std::puts("\nParameters of the autopilot: slot.kind.name, unit, default, bounds, meaning");
  autopilot::for_each_slot([&](const auto& slot) { print_parameters(slot.name, modules.*slot.kinds); });
  return kExitPass;
}

}  // namespace

Verb topics_verb() {
  return {"topics", "print every signal and parameter with unit and meaning", [](VerbOptions& options) {
            options.footer("Example:\n  ironbird topics | grep estimate");
            return [](const autopilot::Modules& modules) { return topics(modules); };
          }};
}

}  // namespace ironbird::scenarios
