#include "autopilot/modules.hpp"

#include "autopilot/controller/cascaded_controller.hpp"
#include "autopilot/estimator/ekf.hpp"
#include "autopilot/estimator/error_state_filter.hpp"
#include "autopilot/estimator/external_pose_estimator.hpp"
#include "autopilot/path_manager/minimum_snap_manager.hpp"
#include "autopilot/path_manager/smoothstep_manager.hpp"
#include "autopilot/path_planner/waypoint_planner.hpp"
#include "autopilot/trajectory_follower/flat_pid_follower.hpp"

namespace ironbird::autopilot {

Modules standard_modules() {
  Modules modules;
  modules.estimators.add<Ekf>("ekf");
  modules.estimators.add<ErrorStateFilter>("error_state");
  modules.estimators.add<ExternalPoseEstimator>("external_pose");
  modules.path_planners.add<WaypointPlanner>("waypoint_planner");
  modules.path_managers.add<SmoothstepManager>("smoothstep_manager");
  modules.path_managers.add<MinimumSnapManager>("minimum_snap_manager");
  modules.trajectory_followers.add<FlatPidFollower>("flat_pid_follower");
  modules.controllers.add<CascadedController>("cascaded_controller");
  return modules;
}

}  // namespace ironbird::autopilot
