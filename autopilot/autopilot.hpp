#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "autopilot/modules.hpp"
#include "autopilot/request.hpp"
#include "autopilot/signals.hpp"

namespace ironbird::autopilot {

/// Which module flies in each slot, and how often it works.
struct AutopilotConfig {
  struct Slot {
    std::string kind;
    Time period{0};

    template <class Self, class Visit>
    static void describe(Self& self, Visit&& visit) {
      visit("kind", self.kind, "", "name in the registry of modules");
      visit("period", self.period, "ns", "of the module's work; 0: every tick");
    }
  };
  Slot estimator{"ekf", Time{0}};
  Slot path_planner{"waypoint_planner", Time{0}};
  Slot path_manager{"smoothstep_manager", Time{0}};
  Slot trajectory_follower{"flat_pid_follower", Time{0}};
  Slot controller{"cascaded_controller", Time{0}};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("estimator", self.estimator, "", "the module in this slot");
    visit("path_planner", self.path_planner, "", "the module in this slot");
    visit("path_manager", self.path_manager, "", "the module in this slot");
    visit("trajectory_follower", self.trajectory_follower, "", "the module in this slot");
    visit("controller", self.controller, "", "the module in this slot");
  }
};

/// Flies one multirotor. A pure stepping object: no clock, no threads, no I/O.
///
/// The complete input of a flight is the configuration, the frames and the requests. ROScopter paper,
/// architecture figure.
class Autopilot {
 public:
  /// @throws std::invalid_argument when a kind is unknown; the message names the slot, the kind and the kinds
  /// there are.
  Autopilot(const AutopilotConfig& config, const Modules& modules);
  ~Autopilot();

  /// One tick: everything the FCU reported since the last tick in, one command out.
  /// @param frame  in stamp order; an older frame is refused and counted by the estimator
  const FcuCommand& step(const SensorFrame& frame);

  /// Applies an operator's wish between two ticks. Builds new modules here, outside the tick.
  RequestOutcome request(const Request& request);

  /// Everything the last step computed. Valid until the next step.
  const Signals& signals() const { return signals_; }

  /// All parameters of the modules in force, under `estimator.…`, `path_manager.…` and so on.
  ParameterTable& parameters() { return parameters_; }

  const Estimator& estimator() const { return *estimator_; }
  const PathPlanner& path_planner() const { return *path_planner_; }
  const PathManager& path_manager() const { return *path_manager_; }
  const TrajectoryFollower& trajectory_follower() const { return *trajectory_follower_; }
  const Controller& controller() const { return *controller_; }

 private:
  RequestOutcome swap(const SwapModule& wish);
  RequestOutcome set(const SetParameter& wish);
  RequestOutcome fly(const OverrideSetpoint& wish);
  bool in_flight() const;
  void note_flight();
  auto places() {
    return std::tie(estimator_, path_planner_, path_manager_, trajectory_follower_, controller_);
  }

  Modules modules_;
  AutopilotConfig config_;
  std::unique_ptr<Estimator> estimator_;
  std::unique_ptr<PathPlanner> path_planner_;
  std::unique_ptr<PathManager> path_manager_;
  std::unique_ptr<TrajectoryFollower> trajectory_follower_;
  std::unique_ptr<Controller> controller_;
  ParameterTable parameters_;
  std::vector<ParameterSetting> asked_;            // by request, the newest value of each
  std::vector<ParameterSetting> asked_in_flight_;  // likewise: not what anything is configured to
  std::optional<ControlSetpoint> override_;
  bool new_setpoint_ = false;  // `override_` was asked for since the last tick
  std::uint32_t route_revision_ = 0;
  Signals signals_;
};

/// A place for an exchangeable module: its name, and where its configuration, the kinds for it, and the
/// module that flies in it are found. No `describe`: it holds pointers to members.
template <class Base>
struct ModuleSlot {
  using Module = Base;

  const char* name;
  AutopilotConfig::Slot AutopilotConfig::*config;
  Registry<Base> Modules::*kinds;
  const Base& (Autopilot::*module)() const;
};

/// The slots, in the order in which their modules work.
inline constexpr std::tuple kModuleSlots{
    ModuleSlot<Estimator>{"estimator", &AutopilotConfig::estimator, &Modules::estimators,
                          &Autopilot::estimator},
    ModuleSlot<PathPlanner>{"path_planner", &AutopilotConfig::path_planner, &Modules::path_planners,
                            &Autopilot::path_planner},
    ModuleSlot<PathManager>{"path_manager", &AutopilotConfig::path_manager, &Modules::path_managers,
                            &Autopilot::path_manager},
    ModuleSlot<TrajectoryFollower>{"trajectory_follower", &AutopilotConfig::trajectory_follower,
                                   &Modules::trajectory_followers, &Autopilot::trajectory_follower},
    ModuleSlot<Controller>{"controller", &AutopilotConfig::controller, &Modules::controllers,
                           &Autopilot::controller}};

/// Calls `visit` with each ModuleSlot.
template <class Visit>
void for_each_slot(Visit&& visit) {
  std::apply([&](const auto&... slot) { (visit(slot), ...); }, kModuleSlots);
}

}  // namespace ironbird::autopilot
