#include <benchmark/benchmark.h>

#include <memory>

#include "autopilot/autopilot.hpp"
#include "autopilot/handover.hpp"
#include "autopilot/path_manager/minimum_snap_trajectory.hpp"
#include "autopilot/test/little_vehicle.hpp"
#include "ci/yardstick/in_turns.hpp"

namespace ironbird::autopilot {
namespace {

SetRoute square() {
  SetRoute route;
  for (const Vector3& p_N :
       {Vector3(0, 0, -5), Vector3(-20, 0, -8), Vector3(-20, 20, -5), Vector3(0, 20, -5)}) {
    Waypoint waypoint;
    waypoint.p_N = p_N;
    waypoint.heading = 2.27;
    route.waypoints.push_back(waypoint);
  }
  route.cyclic = true;
  return route;
}

/// An autopilot that has taken off and flies a square without end, and its vehicle.
struct Flight {
  explicit Flight(const AutopilotConfig& config) : autopilot(config, standard_modules()) {
    autopilot.request(RouteRequest{square()});
    vehicle.status.armed = true;
    vehicle.fly(autopilot.step(vehicle.frame()));
    autopilot.request(TakeOff{});
    for (int i = 0; i < 8000; ++i) vehicle.fly(autopilot.step(vehicle.frame()));
  }

  Autopilot autopilot;
  LittleVehicle vehicle;
};

AutopilotConfig with(const char* manager) {
  AutopilotConfig config;
  config.estimator.kind = "external_pose";
  config.path_manager.kind = manager;
  return config;
}

/// One tick of the whole autopilot on an external pose. The vehicle stands still in time while it is
/// measured.
void whole_step(benchmark::State& state, const char* manager) {
  Flight flight(with(manager));
  SensorFrame frame = flight.vehicle.frame();
  yardstick::beside_rk4(state, 0.0, [&] {
    frame.imu.stamp += std::chrono::nanoseconds(1);
    frame.external_pose->stamp = frame.imu.stamp;
    benchmark::DoNotOptimize(flight.autopilot.step(frame));
  });
}
BENCHMARK_CAPTURE(whole_step, smoothstep, "smoothstep_manager")->Name("WholeStepBesideRk4")->UseManualTime();

/// Planner, manager, follower and controller on the way along a leg, one of them at a time or all together.
class Guidance {
 public:
  explicit Guidance(const char* manager)
      : flight_(with(manager)),
        modules_(standard_modules()),
        planner_(modules_.path_planners.make("waypoint_planner")),
        manager_(modules_.path_managers.make(manager)),
        follower_(modules_.trajectory_followers.make("flat_pid_follower")),
        controller_(modules_.controllers.make("cascaded_controller")),
        estimate_(flight_.autopilot.signals().estimate),
        status_(flight_.autopilot.signals().flight) {
    planner_->take_over(flight_.autopilot.signals());
    controller_->take_over(flight_.autopilot.signals());
    all();
  }

  void plan() { route_ = &planner_->run(estimate_, status_); }
  void manage() { point_ = &manager_->run(*route_, estimate_, status_); }
  void follow() { setpoint_ = &follower_->run(*point_, estimate_, status_); }
  void control() {
    benchmark::DoNotOptimize(controller_->run(*setpoint_, point_->landing, estimate_, status_.fcu));
  }
  void all() {
    plan();
    manage();
    follow();
    control();
  }
  /// Time has to go on for a module to do anything.
  void tick() { estimate_.stamp += std::chrono::nanoseconds(1); }
  bool flies() const { return controller_->phase() == FlightPhase::kOffboard; }

 private:
  Flight flight_;
  Modules modules_;
  std::unique_ptr<PathPlanner> planner_;
  std::unique_ptr<PathManager> manager_;
  std::unique_ptr<TrajectoryFollower> follower_;
  std::unique_ptr<Controller> controller_;
  StateEstimate estimate_;
  FlightStatus status_;
  const Route* route_ = nullptr;
  const TrajectoryPoint* point_ = nullptr;
  const ControlSetpoint* setpoint_ = nullptr;
};

void time_guidance(benchmark::State& state, const char* manager, void (Guidance::*work)()) {
  Guidance guidance(manager);
  yardstick::beside_rk4(state, 0.0, [&] {
    guidance.tick();
    (guidance.*work)();
  });
  if (!guidance.flies()) state.SkipWithError("it did not fly");
}

constexpr const char* kSmoothstep = "smoothstep_manager";
constexpr const char* kMinimumSnap = "minimum_snap_manager";

BENCHMARK_CAPTURE(time_guidance, planner, kSmoothstep, &Guidance::plan)
    ->Name("PlannerBesideRk4")
    ->UseManualTime();
BENCHMARK_CAPTURE(time_guidance, manager, kSmoothstep, &Guidance::manage)
    ->Name("ManagerBesideRk4")
    ->UseManualTime();
BENCHMARK_CAPTURE(time_guidance, snap, kMinimumSnap, &Guidance::manage)
    ->Name("MinimumSnapManagerBesideRk4")
    ->UseManualTime();
BENCHMARK_CAPTURE(time_guidance, follower, kSmoothstep, &Guidance::follow)
    ->Name("FollowerBesideRk4")
    ->UseManualTime();
BENCHMARK_CAPTURE(time_guidance, controller, kSmoothstep, &Guidance::control)
    ->Name("ControllerBesideRk4")
    ->UseManualTime();
BENCHMARK_CAPTURE(time_guidance, all, kSmoothstep, &Guidance::all)
    ->Name("PlannerToControllerBesideRk4")
    ->UseManualTime();

/// How far from its legs a path of least snap may stray, m.
constexpr double kExcursion = 1.0;

/// Planning a trajectory of least snap through as many waypoints as one holds: the longest tick there is.
void minimum_snap_plan(benchmark::State& state) {
  const auto segments = static_cast<std::size_t>(state.range(0));
  MinimumSnapTrajectory trajectory;
  for (auto _ : state) {
    trajectory.begin(Vector3::Zero(), 0.0);
    for (std::size_t i = 1; i <= segments; ++i) {
      trajectory.add(Vector3(10.0 * static_cast<double>(i % 3), 5.0 * static_cast<double>(i), -5.0), 0.0,
                     3.0);
    }
    benchmark::DoNotOptimize(trajectory.solve(MotionLimits{}, kExcursion));
    benchmark::DoNotOptimize(trajectory.duration());
  }
}
BENCHMARK(minimum_snap_plan)->Arg(3)->Arg(64);

}  // namespace
}  // namespace ironbird::autopilot
