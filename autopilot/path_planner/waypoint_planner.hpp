#pragma once

#include <vector>

#include "autopilot/module/tunable.hpp"
#include "autopilot/path_planner/path_planner.hpp"

namespace ironbird::autopilot {

/// Constants of the waypoint planner.
struct WaypointPlannerParams {
  double return_height = 5.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("return_height", self.return_height, "m",
          "least height above the take-off place at which the vehicle returns to launch", 0.0, 500.0);
  }
};

/// Keeps a list of waypoints that the operator edits. ROScopter paper, path planner.
///
/// The route in force is the wanted list with every geodetic waypoint turned into N, in double precision,
/// about the origin of the estimate. While an origin is missing the list waits and the route in force stays
/// as it was. It does not plan around obstacles, and it does not know which leg is being flown.
class WaypointPlanner final : public Tunable<PathPlanner, WaypointPlannerParams> {
 public:
  WaypointPlanner();

  /// Refused: a bad index, values outside the bounds of Waypoint, more than kMostWaypoints, a negative hold,
  /// a return when the vehicle has not taken off.
  bool request(const RouteRequest& request, const StateEstimate& estimate) override;

  void reset() override;
  void hand_over(Handover& handover) const override;
  void take_over(const Handover& left) override;

  const SetRoute& wanted() const override { return wanted_; }
  const Route& route() const override { return route_; }
  bool waits_for_origin() const { return waiting_; }

 protected:
  void plan(const StateEstimate& estimate, const FlightStatus& flight, double dt) override;

 private:
  bool apply(const AddWaypoint& wish, const StateEstimate& estimate);
  bool apply(const RemoveWaypoint& wish, const StateEstimate& estimate);
  bool apply(const SetRoute& wish, const StateEstimate& estimate);
  bool apply(const ClearRoute& wish, const StateEstimate& estimate);
  bool apply(const HoldHere& wish, const StateEstimate& estimate);
  bool apply(const Release& wish, const StateEstimate& estimate);
  bool apply(const ReturnToLaunch& wish, const StateEstimate& estimate);
  bool replace(const std::vector<Waypoint>& waypoints, bool cyclic, const StateEstimate& estimate);
  void put_in_force(const LocalOrigin& origin);

  SetRoute wanted_;
  bool waiting_ = false;
  bool geodetic_ = false;
  std::uint32_t last_id_ = 0;
  LocalOrigin origin_;
  FlightMemory flight_;
  Route route_;
};

}  // namespace ironbird::autopilot
