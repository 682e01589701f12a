#pragma once

#include "autopilot/controller/controller.hpp"
#include "autopilot/estimator/estimator.hpp"
#include "autopilot/module/registry.hpp"
#include "autopilot/path_manager/path_manager.hpp"
#include "autopilot/path_planner/path_planner.hpp"
#include "autopilot/trajectory_follower/trajectory_follower.hpp"

namespace ironbird::autopilot {

/// The kinds of module that can be chosen by name. A researcher's own kind is one `add` on a copy of
/// standard_modules(). No `describe`: it holds makers of modules, not quantities.
struct Modules {
  Registry<Estimator> estimators;
  Registry<PathPlanner> path_planners;
  Registry<PathManager> path_managers;
  Registry<TrajectoryFollower> trajectory_followers;
  Registry<Controller> controllers;
};

/// Every kind that ships with Ironbird.
Modules standard_modules();

}  // namespace ironbird::autopilot
