#pragma once

#include "autopilot/module/module.hpp"
#include "autopilot/request.hpp"
#include "autopilot/types/flight_status.hpp"
#include "autopilot/types/mission.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Keeps the route: what the operator wants flown.
class PathPlanner : public Module {
 public:
  /// One step. @return the route in force; valid until the next call or wish
  const Route& run(const StateEstimate& estimate, const FlightStatus& flight);

  /// Applies an operator's wish that concerns the route. @return false, with nothing changed, when it cannot
  /// be done.
  virtual bool request(const RouteRequest& request, const StateEstimate& estimate) = 0;

  /// What the operator wants; not yet in force when one of the waypoints waits for an origin.
  virtual const SetRoute& wanted() const = 0;

  /// The route in force after every wish granted so far.
  virtual const Route& route() const = 0;

  void reset() override;
  void hand_over(Handover& handover) const override;

 protected:
  /// The work: updates the route. @param dt  time since the previous call, s; 0 on the first
  virtual void plan(const StateEstimate& estimate, const FlightStatus& flight, double dt) = 0;

 private:
  Divider divider_;
};

}  // namespace ironbird::autopilot
