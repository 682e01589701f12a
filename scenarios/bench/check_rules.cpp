#include "scenarios/bench/check_rules.hpp"

#include <memory>
#include <stdexcept>

#include "scenarios/bench/event_names.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/requirements/check.hpp"
#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/quantity_text.hpp"
#include "scenarios/requirements/window.hpp"

namespace ironbird::scenarios {

namespace {

/// What the checks could name in a run, without a run.
struct Still {
  simulator::Truth truth;
  autopilot::Signals autopilot;
  hil_bridge::Telemetry fcu;
  hil_bridge::LinkHealth link;
  hil_bridge::CanMotorsStatus can;
  SignalTable table;
  explicit Still(const Scenario& scenario) {
    add_signals(table, &truth, autopilot, fcu, scenario.vehicle.rotors.size());
    add_link_signals(table, scenario, link, can);
  }
};

class CheckRules {
 public:
  explicit CheckRules(const LoadedScenario& loaded)
      : loaded_(loaded), names_(loaded.scenario), still_(std::make_unique<Still>(loaded.scenario)) {}

  std::vector<std::string> findings() {
    for (std::size_t i = 0; i < loaded_.scenario.checks.size(); ++i) {
      const std::string path = "check[" + std::to_string(i) + "]";
      const CheckConfig& check = loaded_.scenario.checks[i];
      check_name(path, i);
      try {
        const Check possible(check,
                             {&still_->table, &still_->autopilot, to_seconds(loaded_.scenario.fcu.tick)});
        check_events(path, check);
        check_times(path, check);
      } catch (const std::invalid_argument& error) {
        findings_.push_back(complaint_at(path, error.what()));
      }
    }
    return std::move(findings_);
  }

 private:
  void check_events(const std::string& path, const CheckConfig& check) {
    check_event(path + ".after", Moment::read(check.after, "after").event);
    check_event(path + ".until", Moment::read(check.until, "until").event);
    check_list(path + ".order_of_events", check.order_of_events);
    check_list(path + ".none_of_events", check.none_of_events);
  }

  void check_list(const std::string& path, const std::optional<std::vector<std::string>>& events) {
    for (std::size_t i = 0; events && i < events->size(); ++i)
      check_listed(path + "[" + std::to_string(i) + "]", (*events)[i]);
  }

  /// Two checks that are told apart by nothing: the table, the JUnit file and the reasons go by the name.
  void check_name(const std::string& path, std::size_t index) {
    const std::vector<CheckConfig>& checks = loaded_.scenario.checks;
    for (std::size_t i = 0; i < index; ++i) {
      if (checks[index].name.empty() || checks[i].name != checks[index].name) continue;
      findings_.push_back(path + ".name = \"" + checks[index].name + "\": check[" + std::to_string(i) +
                          "] has this name too; must be another");
      return;
    }
  }

  /// Times that lie beyond the end of every run of the scenario.
  void check_times(const std::string& path, const CheckConfig& check) {
    check_moment(path + ".after", check.after);
    check_moment(path + ".until", check.until);
    if (check.settles) check_time(path + ".settles.time", check.settles->time);
    check_time(path + ".tolerated_for", check.tolerated_for);
  }

  void check_moment(const std::string& path, const std::string& text) {
    if (Moment::read(text, path).event.empty()) check_time(path, text);
  }

  void check_time(const std::string& path, const std::string& text) {
    const double duration = loaded_.scenario.duration;
    if (text.empty() || read_quantity(text, "s", path) <= duration) return;
    findings_.push_back(
        path + " = \"" + text +
        "\": lies beyond the end of the run, must be at most duration = " + with_unit(duration, "s"));
  }

  void check_listed(const std::string& path, const std::string& event) {
    if (event.empty()) findings_.push_back(path + " = \"\": must name an event");
    check_event(path, event);
  }

  void check_event(const std::string& path, const std::string& event) {
    if (event.empty()) return;
    const std::string wrong = names_.complaint(event, EventNames::Waiting::kCheck);
    if (!wrong.empty()) findings_.push_back(path + " = \"" + event + "\": " + wrong);
  }

  const LoadedScenario& loaded_;
  const EventNames names_;
  std::unique_ptr<Still> still_;
  std::vector<std::string> findings_;
};

}  // namespace

void add_signals(SignalTable& table, const simulator::Truth* truth, const autopilot::Signals& autopilot,
                 const hil_bridge::Telemetry& fcu, std::size_t rotors) {
  if (truth != nullptr) table.add("truth", *truth);
  table.add("autopilot", autopilot);
  table.add("fcu", fcu);
  const std::string has = "the vehicle has " + std::to_string(rotors) + " rotors, from [0] to [" +
                          std::to_string(rotors - 1) + "]";
  if (truth != nullptr) table.shorten("truth.rotor_speed", rotors, has);
  table.shorten("fcu.output_raw.values", rotors, "it drives no rotor: " + has);
}

void add_link_signals(SignalTable& table, const Scenario& scenario, const hil_bridge::LinkHealth& link,
                      const hil_bridge::CanMotorsStatus& can) {
  const FcuConfig& fcu = scenario.fcu;
  if (fcu.kind == FcuKind::kVirtual) return;
  table.add("link", link);
  if (fcu.kind != FcuKind::kHil || fcu.motors == kOutputRaw) return;
  table.add("can", can);
}

std::vector<std::string> check_findings(const LoadedScenario& loaded) {
  return CheckRules(loaded).findings();
}

}  // namespace ironbird::scenarios
