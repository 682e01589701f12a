#include "scenarios/report/flight_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/record/held_column.hpp"
#include "scenarios/record/logged_route.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/requirements/attitude.hpp"
#include "scenarios/requirements/metrics.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::array<const char*, 3> kAxisSuffixes{".x", ".y", ".z"};

double mix(double a, double b, double share) {
  return a + share * (b - a);
}

double mix_angles(double a, double b, double share) {
  return wrapped(a + share * wrapped(b - a));
}

Curve sampled(const Curve& curve, const std::vector<double>& time,
              double (*between)(double, double, double)) {
  Curve out;
  if (curve.empty()) return out;
  out.time = time;
  out.value.reserve(time.size());
  std::size_t next = 0;  // the first message after t
  for (const double t : time) {
    while (next < curve.time.size() && curve.time[next] <= t) ++next;
    if (next == 0 || next == curve.time.size()) {
      out.value.push_back(next == 0 ? curve.value.front() : curve.value.back());
      continue;
    }
    const double share = (t - curve.time[next - 1]) / (curve.time[next] - curve.time[next - 1]);
    out.value.push_back(between(curve.value[next - 1], curve.value[next], share));
  }
  return out;
}

Curve difference(const Curve& a, const Curve& b, bool angle) {
  Curve out;
  if (a.empty() || b.empty()) return out;
  const Curve other = angle ? resampled_angle(b, a.time) : resampled(b, a.time);
  out.time = a.time;
  for (std::size_t i = 0; i < a.value.size(); ++i) {
    const double error = a.value[i] - other.value[i];
    out.value.push_back(angle ? wrapped(error) : error);
  }
  return out;
}

Curves vector_of(const ReportRun& run, std::string_view topic, const std::string& field) {
  Curves out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = curve_of(run, topic, field + kAxisSuffixes[i]);
  return out;
}

/// Quaternions of a topic; empty when one of the four columns is not there.
std::vector<Eigen::Quaterniond> attitudes_of(const ReportRun& run, std::string_view topic,
                                             const std::string& field) {
  std::vector<Eigen::Quaterniond> out;
  const std::vector<double>& w = run.column(topic, field + ".w");
  const std::vector<double>& x = run.column(topic, field + ".x");
  const std::vector<double>& y = run.column(topic, field + ".y");
  const std::vector<double>& z = run.column(topic, field + ".z");
  const std::size_t size = std::min({w.size(), x.size(), y.size(), z.size()});
  out.reserve(size);
  for (std::size_t i = 0; i < size; ++i) out.emplace_back(w[i], x[i], y[i], z[i]);
  return out;
}

/// As the metrics take it.
autopilot::Route as_route(const LoggedRoute& logged) {
  autopilot::Route route;
  route.cyclic = logged.cyclic;
  for (const Eigen::Vector3d& p_N : logged.waypoints_N) {
    autopilot::Waypoint waypoint;
    waypoint.p_N = p_N;
    route.waypoints.push_back(waypoint);
  }
  return route;
}

HeldColumn held(const ReportRun& run, const char* topic, const char* field) {
  return {run.log().topic(topic), field, 0.0};
}

/// Who flew at a moment of the log.
class WhoFlies {
 public:
  explicit WhoFlies(const ReportRun& run)
      : phase_(held(run, kFlightTopic, "phase")),
        armed_(held(run, kFlightTopic, "fcu.armed")),
        operator_setpoint_(held(run, kFlightTopic, "operator_setpoint")),
        failsafe_(held(run, kFlightTopic, "fcu.failsafe")),
        override_(held(run, kFlightTopic, "fcu.rc_override")) {}

  /// @param time  s, not before that of the call before
  autopilot::FlightStatus at(double time) {
    autopilot::FlightStatus flight;
    flight.phase = static_cast<autopilot::FlightPhase>(static_cast<int>(phase_.at(time)));
    flight.fcu.armed = armed_.at(time) == 1.0;
    flight.operator_setpoint = operator_setpoint_.at(time) == 1.0;
    flight.fcu.failsafe = failsafe_.at(time) == 1.0;
    flight.fcu.rc_override = static_cast<std::uint16_t>(override_.at(time));
    return flight;
  }

 private:
  HeldColumn phase_;
  HeldColumn armed_;
  HeldColumn operator_setpoint_;
  HeldColumn failsafe_;
  HeldColumn override_;
};

/// Whether a moment of the log counts for the path error.
class LegUnderWay {
 public:
  explicit LegUnderWay(const ReportRun& run)
      : flight_(run),
        valid_(held(run, kTrajectoryTopic, "valid")),
        reached_(held(run, kTrajectoryTopic, "reached")),
        finished_(held(run, kTrajectoryTopic, "finished")),
        landing_(held(run, kTrajectoryTopic, "landing")) {}

  /// @param time  s, not before that of the call before
  bool at(double time, const autopilot::Route& route) {
    autopilot::TrajectoryPoint trajectory;
    trajectory.valid = valid_.at(time) == 1.0;
    trajectory.reached = static_cast<std::uint32_t>(reached_.at(time));
    trajectory.finished = finished_.at(time) == 1.0;
    trajectory.landing = landing_.at(time) == 1.0;
    return counts_for_path(flight_.at(time), trajectory, route);
  }

 private:
  WhoFlies flight_;
  HeldColumn valid_;
  HeldColumn reached_;
  HeldColumn finished_;
  HeldColumn landing_;
};

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

/// Gaps elsewhere; without the topic nobody knows, and all stays.
Curve while_flown(const ReportRun& run, Curve curve, bool (autopilot::FlightStatus::*flown)() const) {
  if (run.log().topic(kFlightTopic) == nullptr) return curve;
  WhoFlies flight(run);
  for (std::size_t i = 0; i < curve.value.size(); ++i) {
    if (!(flight.at(curve.time[i]).*flown)()) curve.value[i] = kGap;
  }
  return curve;
}

Curves estimates_of(const ReportRun& run, const std::string& field) {
  Curves out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = estimate_of(run, field + kAxisSuffixes[i]);
  return out;
}

}  // namespace

Curve curve_of(const ReportRun& run, std::string_view topic, std::string_view field) {
  const std::vector<double>& value = run.column(topic, field);
  if (value.empty()) return {};
  return {run.time(topic), value};
}

Curve trajectory_of(const ReportRun& run, std::string_view field) {
  Curve out = curve_of(run, kTrajectoryTopic, field);
  const std::vector<double>& valid = run.column(kTrajectoryTopic, "valid");
  for (std::size_t i = 0; i < std::min(out.value.size(), valid.size()); ++i) {
    if (valid[i] == 0.0) out.value[i] = kGap;
  }
  return while_flown(run, std::move(out), &autopilot::FlightStatus::companion_flies);
}

Curve setpoint_of(const ReportRun& run, const std::vector<std::string>& names) {
  Curve out;
  const LogTopic* topic = run.log().topic(kSetpointTopic);
  if (topic == nullptr) return out;
  for (const std::string& field : topic->fields()) {
    const auto ends_field = [&](const std::string& name) { return field.ends_with("." + name); };
    if (std::none_of(names.begin(), names.end(), ends_field)) continue;
    const Curve here = curve_of(run, kSetpointTopic, field);
    if (out.empty()) out = here;
    for (std::size_t i = 0; i < here.value.size(); ++i) {
      if (std::isfinite(here.value[i])) out.value[i] = here.value[i];
    }
  }
  return while_flown(run, std::move(out), &autopilot::FlightStatus::setpoint_flies);
}

Curve command_of(const ReportRun& run, std::string_view field, const std::vector<std::string>& names) {
  const Curve by_operator = setpoint_of(run, names);
  Curve out = trajectory_of(run, field);
  if (out.empty()) return by_operator;
  std::size_t next = 0;  // the first setpoint after t
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    while (next < by_operator.time.size() && by_operator.time[next] <= out.time[i]) ++next;
    if (std::isnan(out.value[i]) && next > 0) out.value[i] = by_operator.value[next - 1];
  }
  return out;
}

Curve estimate_of(const ReportRun& run, std::string_view field) {
  constexpr auto kNone = static_cast<double>(autopilot::Health::kUninitialised);
  Curve out = curve_of(run, kEstimateTopic, field);
  const std::vector<double>& health = run.column(kEstimateTopic, "health");
  for (std::size_t i = 0; i < std::min(out.value.size(), health.size()); ++i) {
    if (health[i] == kNone) out.value[i] = kGap;
  }
  return out;
}

Curves angles_of(const ReportRun& run, std::string_view topic, const std::string& field) {
  Curves out;
  const std::vector<Eigen::Quaterniond> attitudes = attitudes_of(run, topic, field);
  if (attitudes.empty()) return out;
  for (Curve& curve : out) curve.time = run.time(topic);
  for (const Eigen::Quaterniond& q_NB : attitudes) {
    const EulerAngles angles = euler_of(q_NB);
    out[0].value.push_back(angles.roll);
    out[1].value.push_back(angles.pitch);
    out[2].value.push_back(angles.heading);
  }
  return out;
}

Curve resampled(const Curve& curve, const std::vector<double>& time) {
  return sampled(curve, time, mix);
}

Curve resampled_angle(const Curve& curve, const std::vector<double>& time) {
  return sampled(curve, time, mix_angles);
}

Curves position_error(const ReportRun& run) {
  const Curves estimate = estimates_of(run, "p_NB_N"), truth = vector_of(run, kTruthTopic, "p_NB_N");
  Curves out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = difference(estimate[i], truth[i], false);
  return out;
}

std::optional<double> height_apart(const ReportRun& run) {
  const Curve down = position_error(run)[2];
  HeldColumn in_contact = held(run, kTruthTopic, "in_contact");
  for (std::size_t i = 0; i < down.value.size(); ++i) {
    if (!std::isfinite(down.value[i])) continue;
    return in_contact.at(down.time[i]) == 1.0 ? std::optional(down.value[i]) : std::nullopt;
  }
  return std::nullopt;
}

Curves velocity_error(const ReportRun& run) {
  const std::vector<Eigen::Quaterniond> attitudes = attitudes_of(run, kTruthTopic, "q_NB");
  const Curves v_NB_N = vector_of(run, kTruthTopic, "v_NB_N");
  Curves truth;
  if (v_NB_N[0].value.size() == attitudes.size() && !attitudes.empty()) {
    for (Curve& curve : truth) curve.time = run.time(kTruthTopic);
    for (std::size_t k = 0; k < attitudes.size(); ++k) {
      const Eigen::Vector3d v_N(v_NB_N[0].value[k], v_NB_N[1].value[k], v_NB_N[2].value[k]);
      const Eigen::Vector3d v_B = attitudes[k].conjugate() * v_N;
      for (int i = 0; i < 3; ++i) truth[static_cast<std::size_t>(i)].value.push_back(v_B[i]);
    }
  }
  const Curves estimate = estimates_of(run, "v_NB_B");
  Curves out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = difference(estimate[i], truth[i], false);
  return out;
}

Curves attitude_error(const ReportRun& run) {
  const Curves truth = angles_of(run, kTruthTopic, "q_NB");
  Curves out;
  out[0] = difference(estimate_of(run, "roll"), truth[0], true);
  out[1] = difference(estimate_of(run, "pitch"), truth[1], true);
  out[2] = difference(estimate_of(run, "heading"), truth[2], true);
  return out;
}

Curve scaled(Curve curve, double factor) {
  for (double& value : curve.value) value *= factor;
  return curve;
}

Curve broken_at_wraps(Curve curve) {
  Curve out;
  for (std::size_t i = 0; i < curve.value.size(); ++i) {
    if (i > 0 && std::abs(curve.value[i] - curve.value[i - 1]) > 180.0) {
      out.time.push_back((curve.time[i] + curve.time[i - 1]) / 2.0);
      out.value.push_back(kGap);
    }
    out.time.push_back(curve.time[i]);
    out.value.push_back(curve.value[i]);
  }
  return out;
}

std::vector<std::array<double, 3>> waypoints_of(const ReportRun& run) {
  std::vector<std::array<double, 3>> out;
  const std::vector<LoggedRoute> routes = logged_routes(run.log());
  const std::optional<std::size_t> main = main_route(routes);
  if (!main) return out;
  for (const Eigen::Vector3d& p_N : routes[*main].waypoints_N) out.push_back({p_N.x(), p_N.y(), p_N.z()});
  return out;
}

bool is_cyclic(const ReportRun& run) {
  const std::vector<LoggedRoute> routes = logged_routes(run.log());
  const std::optional<std::size_t> main = main_route(routes);
  return main && routes[*main].cyclic;
}

Curve path_distance(const ReportRun& run, std::string_view topic) {
  Curve out;
  const std::vector<LoggedRoute> routes = logged_routes(run.log());
  const Curves p = vector_of(run, topic, "p_NB_N");
  if (routes.empty() || p[0].empty() || p[1].empty() || p[2].empty()) return out;
  LegUnderWay leg_under_way(run);
  std::size_t at = 0;
  autopilot::Route route = as_route(routes.front());
  bool interrupted = false;
  for (std::size_t k = 0; k < p[0].time.size(); ++k) {
    const double now = p[0].time[k];
    while (at + 1 < routes.size() && routes[at + 1].since <= now) route = as_route(routes[++at]);
    if (!leg_under_way.at(now, route)) {
      interrupted = !out.time.empty();
      continue;
    }
    if (std::exchange(interrupted, false)) {
      out.time.push_back(now);
      out.value.push_back(kGap);
    }
    out.time.push_back(now);
    out.value.push_back(to_polyline({p[0].value[k], p[1].value[k], p[2].value[k]}, route).norm());
  }
  return out;
}

}  // namespace ironbird::scenarios
