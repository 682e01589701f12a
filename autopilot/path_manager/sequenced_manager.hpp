#pragma once

#include <optional>

#include "autopilot/path_manager/motion.hpp"
#include "autopilot/path_manager/path_manager.hpp"

namespace ironbird::autopilot {

/// Walks through the waypoints of a route: which one is next, when it is reached, holds, landings, overrides,
/// changes of the route. How the vehicle moves between waypoints is the business of the derived class.
///
/// * A motion begins where the vehicle is when the companion begins to fly, and again after every override; a
/// vehicle
///   that moves faster than kMovingSpeed is brought to rest first.
/// * The next motion begins at the waypoint, when the one before has ended and the vehicle is within
/// tolerance.
/// * A route that changes under way, and a hold on the spot, brake along the present direction first.
/// * Disarmed and during take-off the route waits at its first waypoint; a hold asked for meanwhile begins
/// when the companion begins to fly.
/// * A hold on the spot interrupts a hold at a waypoint, which then goes on where it was; asked for again, it
/// begins anew.
/// * When the estimated position jumps, the reference jumps along, is brought to rest and makes its way from
/// there.
/// * Without a usable estimate there is nothing to fly, but what has been flown stays told.
/// * When the estimates stop coming for longer than kLongestStep, the motion waits with them.
/// ROScopter paper, path manager; holds, landing, editing under way and overrides are ours.
class SequencedManager : public PathManager {
 public:
  /// Speed above which the reference does not start from rest, m/s.
  static constexpr double kMovingSpeed = 0.5;

  /// A motion goes on by no more than this in one step, unless the period is longer.
  static constexpr Time kLongestStep = std::chrono::milliseconds(20);

  SequencedManager() { noticed_.waypoints.reserve(kMostWaypoints); }

  void reset() override;
  void hand_over(Handover& handover) const override;
  void take_over(const Handover& left) override;
  void probe(ProbeVisitor& visit) const override;

 protected:
  /// How the walk behaves; the derived class fills it from its parameters.
  struct Rules {
    MotionLimits limits;              ///< for braking
    double waypoint_tolerance = 0.5;  ///< m, > 0
    bool switch_early = false;        ///< a waypoint counts as reached as soon as it is within tolerance
    bool never_waits = false;         ///< the clock runs from the arrival of the route, whoever flies
  };

  /// Where a motion begins, at rest.
  struct Departure {
    Vector3 p_N = Vector3::Zero();  ///< m
    double heading = 0.0;           ///< rad
    bool first = false;             ///< nothing of this route has been flown yet
  };

  void set_rules(const Rules& rules) { rules_ = rules; }

  /// Plans the motion from `departure` to waypoint `first` and possibly on. `first` is a valid index.
  /// @return index of the waypoint at which the motion comes to rest, >= first
  virtual std::uint32_t depart(const Departure& departure, const Route& route, std::uint32_t first) = 0;

  /// The planned motion, `elapsed` seconds after its beginning. Before and after it rests at its ends.
  virtual MotionPoint evaluate(double elapsed) const = 0;

  /// True when a motion depends on more of the route than the waypoint it is heading for.
  virtual bool looks_ahead() const { return false; }

  TrajectoryPoint follow(const Route& route, const StateEstimate& estimate, const FlightStatus& flight,
                         double dt) final;

 private:
  enum class Mode : std::uint8_t { kAway, kMotion, kHold, kBrake, kPause, kDone, kLand };

  void wait_on_ground();
  TrajectoryPoint nothing_to_fly();
  void pass_time(Time since_last);
  void notice(const Route& route);
  void end_wait();
  void note(const Route& route);
  void move_with(const StateEstimate& estimate);
  void find_place(const Route& route);
  void begin(const Route& route, const StateEstimate& estimate);
  void step(const Route& route, const StateEstimate& estimate);
  void step_brake(const Route& route);
  void fly_on(const Route& route);
  void step_motion(const Route& route, const StateEstimate& estimate);
  void arrive(const Route& route);
  void advance(const Route& route);
  void leave(const Route& route, const Vector3& p_N, double heading);
  void brake(const MotionPoint& from);
  void rest(Mode mode, const MotionPoint& where);
  bool over(const std::optional<Time>& left) const;
  MotionPoint reference() const;
  TrajectoryPoint point_of(const MotionPoint& motion) const;

  Rules rules_;
  Mode mode_ = Mode::kAway;
  Time now_{0};
  Time began_{0};                  // of the motion or the brake
  std::optional<Time> hold_left_;  // of the hold at the waypoint `index_`; none: until released
  std::optional<Time> pause_left_;
  bool flown_ = false;  // the companion has flown since the vehicle was on the ground
  bool on_motion_ = false;
  Brake brake_;
  MotionPoint rest_;
  std::uint32_t index_ = 0;
  std::uint32_t first_of_motion_ = 0;
  std::uint32_t last_of_motion_ = 0;
  std::uint32_t reached_ = 0;
  bool counted_ = false;  // the waypoint `index_` is among `reached_`
  bool departed_ = false;
  bool was_done_ = false;  // when the estimate was lost
  bool pause_ = false;     // a hold on the spot was asked for and is not over
  bool released_now_ = false;
  bool replan_ = false;
  Route noticed_;  // older than the route in force while this waits for its period or for an estimate
  std::uint32_t newest_id_ = 0;
  std::uint32_t size_ = 0;
  Vector3 position_reset_sum_N_ = Vector3::Zero();
  Waypoint target_;
};

}  // namespace ironbird::autopilot
