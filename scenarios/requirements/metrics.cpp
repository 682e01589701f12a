#include "scenarios/requirements/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>

#include "scenarios/config/degrees.hpp"
#include "scenarios/requirements/attitude.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

void add(std::array<MeanSquare, 3>& axes, const Eigen::Vector3d& error) {
  for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)].add(error[i]);
}

double norm(double a, double b, double c) {
  return std::sqrt(a * a + b * b + c * c);
}

/// The greatest; NaN when any is.
double worst(std::initializer_list<double> values) {
  double out = -std::numeric_limits<double>::infinity();
  for (const double value : values) {
    if (!(value <= out)) out = value;
    if (std::isnan(value)) return value;
  }
  return out;
}

/// From `p` to the nearest point of the segment from `a` to `b`.
Eigen::Vector3d to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length_squared = along.squaredNorm();
  const double share = length_squared > 0.0 ? std::clamp((p - a).dot(along) / length_squared, 0.0, 1.0) : 0.0;
  return a + share * along - p;
}

/// Appends `<stem>_total_m` and the three axes.
void append_axes(std::vector<Metric>& out, const std::string& stem, const std::array<MeanSquare, 3>& axes,
                 const std::string& meaning) {
  const std::array<const char*, 3> names{"north", "east", "down"};
  out.push_back({stem + "_total_m", norm(axes[0].root(), axes[1].root(), axes[2].root()), "m",
                 meaning + ", root of the sum of the axes' mean squares"});
  for (std::size_t i = 0; i < 3; ++i) {
    out.push_back({stem + "_" + names[i] + "_m", axes[i].root(), "m", meaning + ", " + names[i]});
  }
}

}  // namespace

double MeanSquare::root() const {
  return empty() ? kNoFigure : std::sqrt(sum_ / static_cast<double>(count_));
}

Eigen::Vector3d to_polyline(const Eigen::Vector3d& p_N, const autopilot::Route& route) {
  const std::vector<autopilot::Waypoint>& points = route.waypoints;
  if (points.empty()) return Eigen::Vector3d::Zero();
  Eigen::Vector3d nearest = points.front().p_N - p_N;
  const std::size_t segments = route.cyclic ? points.size() : points.size() - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    const Eigen::Vector3d offset = to_segment(p_N, points[i].p_N, points[(i + 1) % points.size()].p_N);
    if (offset.squaredNorm() < nearest.squaredNorm()) nearest = offset;
  }
  return nearest;
}

bool counts_for_path(const autopilot::FlightStatus& flight, const autopilot::TrajectoryPoint& trajectory,
                     const autopilot::Route& route) {
  const bool last_reached = !route.cyclic && trajectory.reached >= route.waypoints.size();
  return flight.companion_flies() && trajectory.valid && trajectory.reached > 0 && !last_reached &&
         !trajectory.finished && !trajectory.landing;
}

RunMetrics::RunMetrics(Sources sources, Time period) : sources_(sources), period_(period) {
  if (sources.autopilot == nullptr) throw std::invalid_argument("metrics need the autopilot's signals");
  if (period <= Time{0}) throw std::invalid_argument("period of the metrics = 0 s, must be > 0");
}

void RunMetrics::sample(Time now) {
  const autopilot::Signals& pilot = *sources_.autopilot;
  const simulator::Truth* truth = sources_.truth;
  const Eigen::Quaterniond& q_NB = truth != nullptr ? truth->q_NB : pilot.estimate.q_NB;
  const double speed = truth != nullptr ? truth->v_NB_N.norm() : pilot.estimate.v_NB_B.norm();
  max_tilt_ = worst({max_tilt_, tilt_of(q_NB)});
  max_speed_ = worst({max_speed_, speed});
  const bool on_ground =
      truth != nullptr ? truth->in_contact : pilot.flight.phase == autopilot::FlightPhase::kDisarmed;
  if (pilot.flight.fcu.armed && !on_ground) {
    airborne_ += period_;
    if (truth != nullptr) sample_estimate();
  }
  sample_path();
  while (next_ <= now) next_ += period_;
}

void RunMetrics::sample_path() {
  const autopilot::Signals& pilot = *sources_.autopilot;
  const autopilot::TrajectoryPoint& trajectory = pilot.trajectory;
  if (!pilot.flight.companion_flies() || !trajectory.valid) return;
  const simulator::Truth* truth = sources_.truth;
  const Eigen::Vector3d& estimated = pilot.estimate.p_NB_N;
  add(tracking_, estimated - trajectory.p_N);
  if (truth != nullptr) add(true_tracking_, truth->p_NB_N - trajectory.p_N);

  if (!counts_for_path(pilot.flight, trajectory, pilot.route)) return;
  add(path_, to_polyline(estimated, pilot.route));
  if (truth != nullptr) add(true_path_, to_polyline(truth->p_NB_N, pilot.route));
}

void RunMetrics::sample_estimate() {
  const autopilot::StateEstimate& estimate = sources_.autopilot->estimate;
  const simulator::Truth& truth = *sources_.truth;
  add(position_, estimate.p_NB_N - truth.p_NB_N);
  add(velocity_, estimate.v_NB_B - truth.q_NB.conjugate() * truth.v_NB_N);
  const EulerAngles estimated = euler_of(estimate.q_NB);
  const EulerAngles true_angles = euler_of(truth.q_NB);
  add(angles_, Eigen::Vector3d(wrapped(estimated.roll - true_angles.roll),
                               wrapped(estimated.pitch - true_angles.pitch),
                               wrapped(estimated.heading - true_angles.heading)));
  attitude_.add(angle_between(truth.q_NB, estimate.q_NB));
}

std::vector<Metric> RunMetrics::names_and_units() {
  const autopilot::Signals nothing;
  return RunMetrics({nullptr, &nothing}).results();
}

void RunMetrics::append_estimate(std::vector<Metric>& out) const {
  const double north = position_[0].root(), east = position_[1].root(), down = position_[2].root();
  const double forward = velocity_[0].root(), right = velocity_[1].root(), below = velocity_[2].root();
  const double roll = angles_[0].root() * kDegreesPerRadian, pitch = angles_[1].root() * kDegreesPerRadian;
  const std::string airborne = ", while airborne";
  const auto append = [&out](const char* name, double value, const char* unit, const std::string& meaning) {
    out.push_back({name, value, unit, meaning});
  };
  append("estimate_position_rms_m", norm(north, east, down), "m", "position error, 3-D" + airborne);
  append("estimate_horizontal_rms_m", worst({north, east}), "m",
         "the worse of position error north and east" + airborne);
  append("estimate_north_rms_m", north, "m", "position error north" + airborne);
  append("estimate_east_rms_m", east, "m", "position error east" + airborne);
  append("estimate_down_rms_m", down, "m", "position error down" + airborne);
  append("estimate_velocity_rms_mps", worst({forward, right, below}), "m/s",
         "the worst axis of the body velocity error" + airborne);
  append("estimate_velocity_total_rms_mps", norm(forward, right, below), "m/s",
         "body velocity error, 3-D" + airborne);
  append("estimate_velocity_forward_rms_mps", forward, "m/s", "body velocity error, forward" + airborne);
  append("estimate_velocity_right_rms_mps", right, "m/s", "body velocity error, right" + airborne);
  append("estimate_velocity_down_rms_mps", below, "m/s", "body velocity error, down" + airborne);
  append("estimate_attitude_rms_deg", attitude_.root() * kDegreesPerRadian, "deg",
         "angle of the attitude error" + airborne);
  append("estimate_roll_pitch_rms_deg", worst({roll, pitch}), "deg",
         "the worse of roll and pitch" + airborne);
  append("estimate_roll_rms_deg", roll, "deg", "roll error" + airborne);
  append("estimate_pitch_rms_deg", pitch, "deg", "pitch error" + airborne);
  append("estimate_heading_rms_deg", angles_[2].root() * kDegreesPerRadian, "deg",
         "heading error" + airborne);
}

std::vector<Metric> RunMetrics::results() const {
  std::vector<Metric> out;
  append_axes(out, "path_rms", path_, "estimate to the nearest point of the waypoints' polyline");
  append_axes(out, "true_path_rms", true_path_, "truth to the nearest point of the waypoints' polyline");
  append_axes(out, "tracking_rms", tracking_, "estimate against the trajectory at the same time");
  append_axes(out, "true_tracking_rms", true_tracking_, "truth against the trajectory at the same time");

  append_estimate(out);
  const auto append = [&out](const char* name, double value, const char* unit, const std::string& meaning) {
    out.push_back({name, value, unit, meaning});
  };
  append("max_tilt_deg", max_tilt_ * kDegreesPerRadian, "deg",
         "greatest angle of the body's down axis to the vertical");
  append("max_speed_mps", max_speed_, "m/s", "greatest speed over ground");
  append(kFlightTime, autopilot::seconds(airborne_), "s", "time airborne");
  append(kSimulatedTime, autopilot::seconds(last_), "s", "length of the run");
  append("real_time_factor", wall_seconds_ > 0.0 ? autopilot::seconds(last_) / wall_seconds_ : kNoFigure, "1",
         "simulated time per wall-clock time");
  return out;
}

}  // namespace ironbird::scenarios
