#include "autopilot/autopilot.hpp"

#include <stdexcept>
#include <type_traits>
#include <utility>

#include "autopilot/handover.hpp"
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

bool belongs(const std::string& path, const std::string& slot) {
  return path.starts_with(slot + ".");
}

/// What the newcomer of a swap is to be told, the strongest last. A predecessor of the same kind has already
/// been told what was asked for in flight.
std::vector<ParameterSetting> inheritance(const SwapModule& wish, bool same_kind, const ParameterTable& table,
                                          const std::vector<ParameterSetting>& asked) {
  std::vector<ParameterSetting> settings;
  for (const ParameterSlot& slot : table.slots()) {
    if (same_kind && belongs(slot.path, wish.slot)) {
      settings.emplace_back(slot.path, *table.get(slot.path));
    }
  }
  settings.insert(settings.end(), wish.settings.begin(), wish.settings.end());
  for (const ParameterSetting& setting : asked) {
    if (belongs(setting.first, wish.slot)) settings.push_back(setting);
  }
  return settings;
}

/// What is asked for in flight is no configuration of the newcomer either: it is measured by that.
/// @return why it cannot be had, or empty
std::string change(ParameterTable& own, const std::string& slot, const std::vector<ParameterSetting>& asked,
                   bool in_flight) {
  for (const auto& [path, value] : asked) {
    if (!belongs(path, slot) || own.find(path) == nullptr) continue;
    std::string why;
    if (own.set(path, value, in_flight, &why) != SetOutcome::kAccepted) {
      return path + ": asked for before, cannot be had of another kind: " + why;
    }
  }
  return {};
}

template <class Base>
RequestOutcome exchange(std::unique_ptr<Base>& place, AutopilotConfig::Slot& slot, const SwapModule& wish,
                        const Registry<Base>& registry, const std::vector<ParameterSetting>& settings,
                        const std::vector<ParameterSetting>& asked_in_flight, ParameterTable& table,
                        Handover left, bool in_flight) {
  std::unique_ptr<Base> newcomer = registry.make(wish.kind);
  if (newcomer == nullptr) return {false, unknown_kind(wish.slot, wish.kind, registry)};
  ParameterTable own;
  newcomer->register_parameters(own, wish.slot);
  if (const std::string conflict = own.set_all(settings); !conflict.empty()) return {false, conflict};
  if (const std::string why = change(own, wish.slot, asked_in_flight, in_flight); !why.empty()) {
    return {false, why};
  }
  if (in_flight && slot.kind == wish.kind) {
    newcomer->configured_like(*place);
    if (const std::string_view why = newcomer->parameter_danger(); !why.empty()) {
      return {false, wish.slot + ": not in flight, " + std::string(why)};
    }
  }
  if (const std::string reason = newcomer->objection(left); !reason.empty()) return {false, reason};
  settle(*newcomer, wish.slot, slot.period, table);
  place->hand_over(left);
  newcomer->take_over(left);
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
  s.trajectory = path_manager_->run(route, s.estimate, s.flight);
  s.setpoint = trajectory_follower_->run(s.trajectory, s.estimate, s.flight);
  if (override_) s.setpoint = *override_;
  s.command = controller_->run(s.setpoint, s.trajectory.landing && !override_, s.estimate, s.flight.fcu);
  new_setpoint_ = false;
  return s.command;
}

RequestOutcome Autopilot::request(const Request& request) {
  if (const auto* wish = std::get_if<RouteRequest>(&request)) {
    const bool stands = controller_->phase() == FlightPhase::kDisarmed || controller_->memory().on_ground;
    if (std::holds_alternative<ReturnToLaunch>(*wish) && stands) return {false, "it is on the ground"};
    if (path_planner_->request(*wish, signals_.estimate)) return {true, ""};
    return {false, "the path planner cannot do this with the present route"};
  }
  if (std::holds_alternative<ListRoute>(request)) return {true, "", path_planner_->wanted().waypoints};
  if (const auto* wish = std::get_if<SetParameter>(&request)) return set(*wish);
  if (const auto* wish = std::get_if<SwapModule>(&request)) return swap(*wish);
  if (const auto* wish = std::get_if<OverrideSetpoint>(&request)) return fly(*wish);
  FlightWish flight_wish = FlightWish::kTakeOff;
  if (std::holds_alternative<Land>(request)) flight_wish = FlightWish::kLand;
  if (std::holds_alternative<Resume>(request)) flight_wish = FlightWish::kResume;
  return controller_->request(flight_wish, signals_.estimate, signals_.flight.fcu);
}

RequestOutcome Autopilot::set(const SetParameter& wish) {
  std::string why;
  const SetOutcome outcome = parameters_.set(wish.path, wish.value, in_flight(), &why);
  if (outcome == SetOutcome::kAccepted) {
    const auto same = [&](const ParameterSetting& setting) { return setting.first == wish.path; };
    std::erase_if(asked_, same);
    std::erase_if(asked_in_flight_, same);
    (in_flight() ? asked_in_flight_ : asked_).emplace_back(wish.path, wish.value);
    return {true, ""};
  }
  std::string reason = wish.path + ": " + std::string(name_of(outcome));
  if (!why.empty()) reason += ", " + why;
  if (outcome == SetOutcome::kOutOfBounds) {
    const ParameterSlot& slot = *parameters_.find(wish.path);
    reason += ", must be within " + std::to_string(slot.lower) + " and " + std::to_string(slot.upper) + " " +
              slot.unit;
  }
  return {false, reason};
}

bool Autopilot::in_flight() const {
  return signals_.flight.fcu.armed && controller_->phase() != FlightPhase::kDisarmed;
}

RequestOutcome Autopilot::fly(const OverrideSetpoint& wish) {
  if (wish.setpoint && !all_finite(*wish.setpoint)) return {false, "the setpoint is not finite"};
  using enum FlightPhase;
  const FlightPhase phase = controller_->phase();
  if (wish.setpoint && (phase == kLanding || phase == kLevelDescent || phase == kSilent)) {
    return {false, "the vehicle is descending or silent: ask to resume first"};
  }
  override_ = wish.setpoint;
  new_setpoint_ = true;
  return {true, ""};
}

void Autopilot::note_flight() {
  signals_.flight.phase = controller_->phase();
  signals_.flight.cause = controller_->cause();
  signals_.flight.memory = controller_->memory();
  // Manager and follower wait meanwhile, as they do when the pilot flies.
  signals_.flight.operator_setpoint = override_.has_value();
}

RequestOutcome Autopilot::swap(const SwapModule& wish) {
  note_flight();
  Handover left(signals_);
  left.new_setpoint = new_setpoint_;
  std::string names;
  std::optional<RequestOutcome> outcome;
  for_each_slot([&]<class Base>(const ModuleSlot<Base>& slot) {
    names += (names.empty() ? "" : ", ") + std::string(slot.name);
    if (wish.slot != slot.name) return;
    AutopilotConfig::Slot& config = config_.*slot.config;
    const bool same_kind = config.kind == wish.kind;
    outcome = exchange(std::get<std::unique_ptr<Base>&>(places()), config, wish, modules_.*slot.kinds,
                       inheritance(wish, same_kind, parameters_, asked_), asked_in_flight_, parameters_, left,
                       in_flight());
  });
  return outcome.value_or(
      RequestOutcome{false, "slot \"" + wish.slot + "\" is unknown; there are: " + names});
}

}  // namespace ironbird::autopilot
