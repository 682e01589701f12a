#include "autopilot/path_manager/sequenced_manager.hpp"

#include <algorithm>
#include <utility>

#include "autopilot/handover.hpp"

namespace ironbird::autopilot {

namespace {

MotionPoint resting_at(const Vector3& p_N, double heading) {
  MotionPoint point;
  point.p_N = p_N;
  point.heading = wrap(heading);
  point.ended = true;
  return point;
}

Time time_from(double seconds) {
  return Time{static_cast<Time::rep>(seconds * 1e9 + 0.5)};
}

std::optional<Time> time_from(const std::optional<double>& seconds) {
  return seconds ? std::optional<Time>(time_from(*seconds)) : std::nullopt;
}

std::optional<double> seconds_of(const std::optional<Time>& time) {
  return time ? std::optional<double>(seconds(*time)) : std::nullopt;
}

std::uint32_t size_of(const Route& route) {
  return static_cast<std::uint32_t>(route.waypoints.size());
}

/// With the memory that it has.
void clear(Route& route) {
  std::vector<Waypoint> memory = std::move(route.waypoints);
  memory.clear();
  route = Route{};
  route.waypoints = std::move(memory);
}

}  // namespace

void SequencedManager::reset() {
  PathManager::reset();
  flown_ = true;
  wait_on_ground();
  now_ = Time{0};
  clear(noticed_);
  newest_id_ = size_ = 0;
  target_ = Waypoint{};
  position_reset_sum_N_.setZero();
}

void SequencedManager::wait_on_ground() {
  mode_ = Mode::kAway;
  index_ = reached_ = 0;
  counted_ = departed_ = on_motion_ = replan_ = was_done_ = false;
  if (flown_) pause_ = false;  // a hold of the flight before; one asked for on the ground is kept
  flown_ = false;
}

void SequencedManager::hand_over(Handover& handover) const {
  handover.route = noticed_;
}

void SequencedManager::take_over(const Handover& left) {
  const TrajectoryPoint& last = left.trajectory;
  note(left.route);
  size_ = size_of(left.route);
  position_reset_sum_N_ = left.estimate.position_reset_sum_N;
  for (const Waypoint& waypoint : left.route.waypoints) newest_id_ = std::max(newest_id_, waypoint.id);
  index_ = std::min(last.leg, size_);
  if (index_ < size_) target_ = left.route.waypoints[index_];
  reached_ = last.reached;
  counted_ = last.at_waypoint;
  hold_left_ = time_from(last.hold_left);
  pause_ = last.paused;
  pause_left_ = time_from(last.pause_left);
  departed_ = true;
  flown_ = left.flight.companion_flies();
  now_ = last.stamp;
  if (!left.flight.companion_flies() || !last.valid) return;
  MotionPoint from = resting_at(last.p_N, last.heading);
  from.v_N = last.v_N;
  from.a_N = last.a_N;
  from.heading_rate = last.heading_rate;
  from.heading_acceleration = last.heading_acceleration;
  brake(from);
}

void SequencedManager::probe(ProbeVisitor& visit) const {
  visit("mode", static_cast<double>(mode_), "1");
  visit("elapsed", seconds(now_ - began_), "s");
}

TrajectoryPoint SequencedManager::follow(const Route& route, const StateEstimate& estimate,
                                         const FlightStatus& flight, double dt) {
  const Time since_last = dt > 0.0 ? estimate.stamp - now_ : Time{0};
  now_ = estimate.stamp;
  if (!is_usable(estimate.health)) return nothing_to_fly();
  const bool waits = !rules_.never_waits && !flight.companion_flies();
  const bool on_ground = flight.phase == FlightPhase::kDisarmed || flight.phase == FlightPhase::kTakeOff;
  if (waits && on_ground) wait_on_ground();
  was_done_ = false;
  flown_ = flown_ || !waits;
  notice(route);
  if (waits || (mode_ == Mode::kAway && size_ == 0)) {
    mode_ = Mode::kAway;
    TrajectoryPoint here = point_of(resting_at(estimate.p_NB_N, estimate.heading));
    here.valid = size_ > 0;
    return here;
  }
  pass_time(since_last);
  move_with(estimate);
  if (mode_ == Mode::kAway) begin(route, estimate);
  step(route, estimate);
  return point_of(reference());
}

TrajectoryPoint SequencedManager::nothing_to_fly() {
  if (mode_ != Mode::kAway) was_done_ = mode_ == Mode::kDone;
  mode_ = Mode::kAway;
  TrajectoryPoint nothing = point_of(MotionPoint{});
  nothing.valid = false;
  nothing.finished = was_done_;
  return nothing;
}

void SequencedManager::pass_time(Time since_last) {
  if (mode_ == Mode::kHold && hold_left_ && !pause_) *hold_left_ -= since_last;
  if (mode_ == Mode::kPause && pause_left_) *pause_left_ -= since_last;
  const bool moves = mode_ == Mode::kBrake || on_motion_;
  if (moves && !rules_.never_waits)
    began_ += std::max(since_last - std::max(kLongestStep, period()), Time{0});
}

void SequencedManager::move_with(const StateEstimate& estimate) {
  const Vector3 jump_N = estimate.position_reset_sum_N - position_reset_sum_N_;
  position_reset_sum_N_ = estimate.position_reset_sum_N;
  if (jump_N.isZero(0.0) || mode_ == Mode::kAway) return;
  MotionPoint from = reference();
  from.p_N += jump_N;
  brake(from);
}

void SequencedManager::notice(const Route& route) {
  released_now_ = route.released != noticed_.released;
  const bool holds_now = route.holds != noticed_.holds;
  // Of a hold and a release that are noticed together the last word counts.
  const bool taken_back = holds_now && released_now_ && route.holds == route.holds_released;
  if (released_now_ && mode_ == Mode::kAway) {  // whoever has the vehicle, a release ends what waits for one
    pause_ = false;
    hold_left_ = Time{0};
  } else if (released_now_ && holds_now && !taken_back) {
    end_wait();
  }
  if (holds_now) released_now_ = false;
  if (holds_now && !taken_back) {
    pause_ = true;
    pause_left_ = time_from(route.hold_time);
  }
  if (route.revision != noticed_.revision) find_place(route);
  note(route);
}

/// By a release: that on the spot, or else that at a waypoint, for which it may be braking after an exchange.
void SequencedManager::end_wait() {
  if (!std::exchange(pause_, false)) hold_left_ = Time{0};
}

void SequencedManager::note(const Route& route) {
  if (route.revision != noticed_.revision) noticed_ = route;  // with memory for all that a route may hold
  noticed_.released = route.released;
  noticed_.holds = route.holds;
}

void SequencedManager::find_place(const Route& route) {
  const auto& waypoints = route.waypoints;
  const auto same = std::find_if(waypoints.begin(), waypoints.end(),
                                 [&](const Waypoint& w) { return index_ < size_ && w.id == target_.id; });
  const bool fresh =
      std::none_of(waypoints.begin(), waypoints.end(), [&](const Waypoint& w) { return w.id <= newest_id_; });
  size_ = size_of(route);
  for (const Waypoint& waypoint : waypoints) newest_id_ = std::max(newest_id_, waypoint.id);
  if (same != waypoints.end()) {
    const auto place = static_cast<std::uint32_t>(same - waypoints.begin());
    first_of_motion_ += place - index_;  // modulo 2^32: may be negative
    last_of_motion_ += place - index_;
    index_ = place;
    replan_ = same->p_N != target_.p_N || same->heading != target_.heading ||
              (looks_ahead() && mode_ == Mode::kMotion);
    return;
  }
  if (fresh) {
    index_ = reached_ = 0;
    departed_ = false;
  } else if (index_ >= size_) {
    index_ = route.cyclic ? 0 : size_;
  }
  counted_ = false;
  replan_ = true;
}

void SequencedManager::begin(const Route& route, const StateEstimate& estimate) {
  replan_ = false;
  MotionPoint here = resting_at(estimate.p_NB_N, estimate.heading);
  here.v_N = estimate.v_NB_N();
  if (!rules_.never_waits && here.v_N.norm() > kMovingSpeed) {
    brake(here);
  } else if (pause_) {
    here.v_N.setZero();
    rest(Mode::kPause, here);
  } else {
    leave(route, here.p_N, here.heading);
  }
}

void SequencedManager::step(const Route& route, const StateEstimate& estimate) {
  const bool stopping = mode_ == Mode::kBrake || mode_ == Mode::kPause;
  if (!stopping && (pause_ || replan_)) brake(reference());
  replan_ = false;
  if (mode_ == Mode::kBrake) step_brake(route);
  if (mode_ == Mode::kPause && over(pause_left_)) {
    pause_ = false;
    leave(route, rest_.p_N, rest_.heading);
  }
  if (mode_ == Mode::kHold && over(hold_left_)) advance(route);
  if (mode_ == Mode::kDone) fly_on(route);
  if (mode_ == Mode::kMotion) step_motion(route, estimate);
}

void SequencedManager::step_brake(const Route& route) {
  if (released_now_) end_wait();
  const MotionPoint stop = reference();
  if (!stop.ended) return;
  if (pause_) {
    rest(Mode::kPause, resting_at(stop.p_N, stop.heading));
  } else {
    leave(route, stop.p_N, stop.heading);
  }
}

void SequencedManager::fly_on(const Route& route) {
  if (index_ >= size_ || (counted_ && index_ + 1 >= size_)) return;
  const MotionPoint from = reference();
  if (counted_) ++index_;
  counted_ = false;
  leave(route, from.p_N, from.heading);
}

void SequencedManager::step_motion(const Route& route, const StateEstimate& estimate) {
  const MotionPoint motion = evaluate(seconds(now_ - began_));
  while (index_ < last_of_motion_ && index_ - first_of_motion_ < motion.passed) {
    ++index_;
    ++reached_;
    counted_ = false;
    target_ = route.waypoints[index_];
  }
  if (index_ != last_of_motion_ || !(motion.ended || rules_.switch_early)) return;
  if ((estimate.p_NB_N - route.waypoints[index_].p_N).norm() <= rules_.waypoint_tolerance) arrive(route);
}

void SequencedManager::arrive(const Route& route) {
  const Waypoint& here = route.waypoints[index_];
  if (!counted_) {
    ++reached_;
    hold_left_ = here.hold_indefinitely ? std::nullopt : std::optional<Time>(time_from(here.hold_time));
  }
  counted_ = true;
  switch (here.kind) {
    case WaypointKind::kGoto:
      advance(route);
      break;
    case WaypointKind::kHold:
      mode_ = Mode::kHold;
      break;
    case WaypointKind::kLand:
      mode_ = Mode::kLand;
      break;
  }
}

void SequencedManager::advance(const Route& route) {
  const bool at_end = index_ + 1 >= size_;
  if (at_end && (!route.cyclic || size_ == 1)) {
    mode_ = Mode::kDone;
    return;
  }
  const Waypoint from = route.waypoints[index_];
  index_ = at_end ? 0 : index_ + 1;
  counted_ = false;
  leave(route, from.p_N, from.heading);
}

void SequencedManager::leave(const Route& route, const Vector3& p_N, double heading) {
  if (index_ >= size_) {
    rest(Mode::kDone, resting_at(p_N, heading));
    return;
  }
  last_of_motion_ = depart({p_N, heading, !departed_}, route, index_);
  first_of_motion_ = index_;
  target_ = route.waypoints[index_];
  departed_ = true;
  mode_ = Mode::kMotion;
  on_motion_ = true;
  began_ = now_;
}

void SequencedManager::brake(const MotionPoint& from) {
  brake_ = Brake(from, rules_.limits);
  mode_ = Mode::kBrake;
  began_ = now_;
}

void SequencedManager::rest(Mode mode, const MotionPoint& where) {
  mode_ = mode;
  rest_ = where;
  on_motion_ = false;
}

bool SequencedManager::over(const std::optional<Time>& left) const {
  return released_now_ || (left && *left <= Time{0});
}

MotionPoint SequencedManager::reference() const {
  if (mode_ == Mode::kBrake) return brake_.evaluate(seconds(now_ - began_));
  return on_motion_ ? evaluate(seconds(now_ - began_)) : rest_;
}

TrajectoryPoint SequencedManager::point_of(const MotionPoint& motion) const {
  TrajectoryPoint point;
  point.stamp = now_;
  point.valid = true;
  point.p_N = motion.p_N;
  point.v_N = motion.v_N;
  point.a_N = motion.a_N;
  point.heading = motion.heading;
  point.heading_rate = motion.heading_rate;
  point.heading_acceleration = motion.heading_acceleration;
  point.leg = index_;
  point.reached = reached_;
  point.at_waypoint = counted_;
  if (counted_) point.hold_left = seconds_of(hold_left_);
  point.paused = pause_;
  if (pause_) point.pause_left = seconds_of(pause_left_);
  point.holding = mode_ == Mode::kHold || mode_ == Mode::kPause;
  point.finished = mode_ == Mode::kDone;
  point.landing = mode_ == Mode::kLand;
  return point;
}

}  // namespace ironbird::autopilot
