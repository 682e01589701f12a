#pragma once

#include "autopilot/module/tunable.hpp"
#include "autopilot/path_manager/minimum_snap_trajectory.hpp"
#include "autopilot/path_manager/sequenced_manager.hpp"

namespace ironbird::autopilot {

/// Constants of the minimum-snap manager.
struct MinimumSnapManagerParams : MotionLimits {
  double waypoint_tolerance = 0.5;
  double max_excursion = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    MotionLimits::describe(self, visit);
    visit("waypoint_tolerance", self.waypoint_tolerance, "m",
          "distance at which a waypoint to stop at is reached", 0.01, 100.0);
    visit("max_excursion", self.max_excursion, "m",
          "how far the way may stray from the straight line between two waypoints", 0.05, 1e3);
  }
};

/// Flies through the waypoints without stopping, on a trajectory of least snap, up to the next hold, landing
/// or end of the route. It stops as well where two waypoints share a place, where flying through would stray
/// too far, and after every kMostLegs waypoints. In a cyclic route it stops at the last waypoint. When the
/// route changes under way it brakes and plans anew.
class MinimumSnapManager final : public Tunable<SequencedManager, MinimumSnapManagerParams> {
 public:
  MinimumSnapManager() { on_parameters(); }

  const MinimumSnapTrajectory& trajectory() const { return trajectory_; }

 protected:
  void on_parameters() override;
  std::uint32_t depart(const Departure& departure, const Route& route, std::uint32_t first) override;
  MotionPoint evaluate(double elapsed) const override { return trajectory_.evaluate(elapsed); }
  bool looks_ahead() const override { return true; }

 private:
  MinimumSnapTrajectory trajectory_;
};

}  // namespace ironbird::autopilot
