#include "autopilot/autopilot.hpp"

#include <stdexcept>
#include <utility>

#include "autopilot/math/finite.hpp"

namespace ironbird::autopilot {

namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

template <class Base>
std::string unknown_kind(const std::string& slot, const std::string& kind, const Registry<Base>& registry) {
  return slot + ".kind = \"" + kind + "\" is unknown; there are: " + joined(registry.names());
}

/// Tells a new module its period and puts its parameters in the table.
void settle(Module& module, const std::string& name, Time period, ParameterTable& table) {
  module.set_period(period);
  table.remove(name);
  module.register_parameters(table, name);
}

template <class Base>
std::unique_ptr<Base> required(const std::string& name, const AutopilotConfig::Slot& slot,
                               const Registry<Base>& registry, ParameterTable& table) {
  if (slot.period < Time{0}) {
    throw std::invalid_argument(name + ".period = " + std::to_string(slot.period.count()) +
                                " ns, must be >= 0");
  }
  std::unique_ptr<Base> module = registry.make(slot.kind);
  if (module == nullptr) throw std::invalid_argument(unknown_kind(name, slot.kind, registry));
  settle(*module, name, slot.period, table);
  return module;
}

template <class Base>
RequestOutcome exchange(std::unique_ptr<Base>& place, AutopilotConfig::Slot& slot, const SwapModule& wish,
                        const Registry<Base>& registry, ParameterTable& table, const Signals& signals) {
  std::unique_ptr<Base> newcomer = registry.make(wish.kind);
  if (newcomer == nullptr) return {false, unknown_kind(wish.slot, wish.kind, registry)};
  if (const std::string reason = newcomer->objection(signals); !reason.empty()) return {false, reason};
  settle(*newcomer, wish.slot, slot.period, table);
  newcomer->take_over(signals);
  place = std::move(newcomer);
  slot.kind = wish.kind;
  return {true, ""};
}

std::string_view name_of(SetOutcome outcome) {
  for (const auto& [value, name] : enumerators(outcome)) {
    if (value == outcome) return name;
  }
  return "";
}

RequestOutcome set_parameter(ParameterTable& table, const SetParameter& wish) {
  const SetOutcome outcome = table.set(wish.path, wish.value);
  if (outcome == SetOutcome::kAccepted) return {true, ""};
  std::string reason = wish.path + ": " + std::string(name_of(outcome));
  if (const ParameterSlot* slot = table.find(wish.path);
      slot != nullptr && outcome == SetOutcome::kOutOfBounds) {
    reason += ", must be within " + std::to_string(slot->lower) + " and " + std::to_string(slot->upper) +
              " " + slot->unit;
  }
  return {false, reason};
}

}  // namespace

Autopilot::Autopilot(const AutopilotConfig& config, const Modules& modules)
    : modules_(modules), config_(config) {
  for_each_slot([&]<class Base>(const ModuleSlot<Base>& slot) {
    std::get<std::unique_ptr<Base>&>(places()) =
        required(slot.name, config.*slot.config, modules.*slot.kinds, parameters_);
  });
  signals_.route.waypoints.reserve(kMostWaypoints);
}

Autopilot::~Autopilot() = default;

const FcuCommand& Autopilot::step(const SensorFrame& frame) {
  Signals& s = signals_;
  s.sensors = frame;
  if (frame.status) s.flight.fcu = *frame.status;
  if (frame.external_pose) s.external_pose_heard = frame.imu.stamp;
  note_flight();
  s.estimate = estimator_->run(frame);
  const Route& route = path_planner_->run(s.estimate, s.flight);
  if (route.revision != route_revision_ || route.released != s.route.released) s.route = route;
  route_revision_ = route.revision;
  FlightStatus offered = s.flight;
  // While an operator's setpoint flies, manager and follower wait as they do when the pilot flies.
  if (override_ && offered.phase == FlightPhase::kOffboard) offered.phase = FlightPhase::kHold;
  s.trajectory = path_manager_->run(route, s.estimate, offered);
  s.setpoint = trajectory_follower_->run(s.trajectory, s.estimate, offered);
  if (override_) s.setpoint = *override_;
  s.command = controller_->run(s.setpoint, s.trajectory.landing && !override_, s.estimate, s.flight.fcu);
  return s.command;
}

RequestOutcome Autopilot::request(const Request& request) {
  if (const auto* wish = std::get_if<RouteRequest>(&request)) {
    if (path_planner_->request(*wish, signals_.estimate)) return {true, ""};
    return {false, "the path planner cannot do this with the present route"};
  }
  if (const auto* wish = std::get_if<SetParameter>(&request)) return set_parameter(parameters_, *wish);
  if (const auto* wish = std::get_if<SwapModule>(&request)) return swap(*wish);
  if (const auto* wish = std::get_if<OverrideSetpoint>(&request)) {
    if (wish->setpoint && !all_finite(*wish->setpoint)) return {false, "the setpoint is not finite"};
    override_ = wish->setpoint;
    return {true, ""};
  }
  FlightWish flight_wish = FlightWish::kTakeOff;
  if (std::holds_alternative<Land>(request)) flight_wish = FlightWish::kLand;
  if (std::holds_alternative<Resume>(request)) flight_wish = FlightWish::kResume;
  return controller_->request(flight_wish, signals_.estimate, signals_.flight.fcu);
}

void Autopilot::note_flight() {
  signals_.flight.phase = controller_->phase();
  signals_.flight.cause = controller_->cause();
  signals_.flight.memory = controller_->memory();
}

RequestOutcome Autopilot::swap(const SwapModule& wish) {
  note_flight();
  std::string names;
  std::optional<RequestOutcome> outcome;
  for_each_slot([&]<class Base>(const ModuleSlot<Base>& slot) {
    names += (names.empty() ? "" : ", ") + std::string(slot.name);
    if (wish.slot != slot.name) return;
    outcome = exchange(std::get<std::unique_ptr<Base>&>(places()), config_.*slot.config, wish,
                       modules_.*slot.kinds, parameters_, signals_);
  });
  return outcome.value_or(
      RequestOutcome{false, "slot \"" + wish.slot + "\" is unknown; there are: " + names});
}

}  // namespace ironbird::autopilot
