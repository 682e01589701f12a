#include <benchmark/benchmark.h>

#include "autopilot/autopilot.hpp"
#include "autopilot/path_manager/minimum_snap_trajectory.hpp"
#include "autopilot/test/little_vehicle.hpp"

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
  for (auto _ : state) {
    frame.imu.stamp += std::chrono::nanoseconds(1);
    frame.external_pose->stamp = frame.imu.stamp;
    benchmark::DoNotOptimize(flight.autopilot.step(frame));
  }
}
BENCHMARK_CAPTURE(whole_step, smoothstep, "smoothstep_manager");
BENCHMARK_CAPTURE(whole_step, minimum_snap, "minimum_snap_manager");

/// Planner, manager, follower and controller without the estimator, on the way along a leg.
void guidance_and_control(benchmark::State& state, const char* manager_kind) {
  Flight flight(with(manager_kind));
  const Modules modules = standard_modules();
  const Signals& signals = flight.autopilot.signals();
  const auto planner = modules.path_planners.make("waypoint_planner");
  const auto manager = modules.path_managers.make(manager_kind);
  const auto follower = modules.trajectory_followers.make("flat_pid_follower");
  const auto controller = modules.controllers.make("cascaded_controller");
  planner->take_over(signals);
  controller->take_over(signals);
  StateEstimate estimate = signals.estimate;
  const FlightStatus status = signals.flight;
  for (auto _ : state) {
    estimate.stamp += std::chrono::nanoseconds(1);
    const Route& route = planner->run(estimate, status);
    const TrajectoryPoint& point = manager->run(route, estimate, status);
    const ControlSetpoint& setpoint = follower->run(point, estimate, status);
    benchmark::DoNotOptimize(controller->run(setpoint, point.landing, estimate, status.fcu));
  }
  if (controller->phase() != FlightPhase::kOffboard) state.SkipWithError("it did not fly");
}
BENCHMARK_CAPTURE(guidance_and_control, smoothstep, "smoothstep_manager");
BENCHMARK_CAPTURE(guidance_and_control, minimum_snap, "minimum_snap_manager");

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
    trajectory.solve(MotionLimits{});
    benchmark::DoNotOptimize(trajectory.duration());
  }
}
BENCHMARK(minimum_snap_plan)->Arg(3)->Arg(64);

}  // namespace
}  // namespace ironbird::autopilot
