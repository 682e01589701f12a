#include "scenarios/report/flight_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "scenarios/requirements/attitude.hpp"
#include "scenarios/requirements/metrics.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kTruth = "/truth/state";
constexpr const char* kEstimate = "/autopilot/estimate";
constexpr const char* kTrajectory = "/autopilot/trajectory";
constexpr const char* kRoute = "/autopilot/route";
constexpr std::array<const char*, 3> kAxes{".x", ".y", ".z"};

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
  for (std::size_t i = 0; i < 3; ++i) out[i] = curve_of(run, topic, field + kAxes[i]);
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

autopilot::Route route_of(const ReportRun& run) {
  autopilot::Route route;
  route.cyclic = is_cyclic(run);
  for (const auto& p : waypoints_of(run)) {
    autopilot::Waypoint waypoint;
    waypoint.p_N = Eigen::Vector3d(p[0], p[1], p[2]);
    route.waypoints.push_back(waypoint);
  }
  return route;
}

}  // namespace

Curve curve_of(const ReportRun& run, std::string_view topic, std::string_view field) {
  const std::vector<double>& value = run.column(topic, field);
  if (value.empty()) return {};
  return {run.time(topic), value};
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
  const Curves estimate = vector_of(run, kEstimate, "p_NB_N"), truth = vector_of(run, kTruth, "p_NB_N");
  Curves out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = difference(estimate[i], truth[i], false);
  return out;
}

Curves velocity_error(const ReportRun& run) {
  const std::vector<Eigen::Quaterniond> attitudes = attitudes_of(run, kTruth, "q_NB");
  const Curves v_NB_N = vector_of(run, kTruth, "v_NB_N");
  Curves truth;
  if (v_NB_N[0].value.size() == attitudes.size() && !attitudes.empty()) {
    for (Curve& curve : truth) curve.time = run.time(kTruth);
    for (std::size_t k = 0; k < attitudes.size(); ++k) {
      const Eigen::Vector3d v_N(v_NB_N[0].value[k], v_NB_N[1].value[k], v_NB_N[2].value[k]);
      const Eigen::Vector3d v_B = attitudes[k].conjugate() * v_N;
      for (int i = 0; i < 3; ++i) truth[static_cast<std::size_t>(i)].value.push_back(v_B[i]);
    }
  }
  const Curves estimate = vector_of(run, kEstimate, "v_NB_B");
  Curves out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = difference(estimate[i], truth[i], false);
  return out;
}

Curves attitude_error(const ReportRun& run) {
  const Curves truth = angles_of(run, kTruth, "q_NB");
  Curves out;
  out[0] = difference(curve_of(run, kEstimate, "roll"), truth[0], true);
  out[1] = difference(curve_of(run, kEstimate, "pitch"), truth[1], true);
  out[2] = difference(curve_of(run, kEstimate, "heading"), truth[2], true);
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
      out.value.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    out.time.push_back(curve.time[i]);
    out.value.push_back(curve.value[i]);
  }
  return out;
}

std::vector<std::array<double, 3>> waypoints_of(const ReportRun& run) {
  std::vector<std::array<double, 3>> out;
  const std::size_t messages = run.time(kRoute).size();
  for (std::size_t k = messages; k > 0 && out.empty(); --k) {
    for (int i = 0;; ++i) {
      const std::string stem = "waypoints[" + std::to_string(i) + "].p_N";
      const std::vector<double>& x = run.column(kRoute, stem + ".x");
      if (x.size() < k || !std::isfinite(x[k - 1])) break;
      const std::vector<double>& y = run.column(kRoute, stem + ".y");
      const std::vector<double>& z = run.column(kRoute, stem + ".z");
      if (y.size() < k || z.size() < k) break;
      out.push_back({x[k - 1], y[k - 1], z[k - 1]});
    }
  }
  return out;
}

bool is_cyclic(const ReportRun& run) {
  const std::vector<double>& cyclic = run.column(kRoute, "cyclic");
  return !cyclic.empty() && cyclic.back() == 1.0;
}

Curve path_distance(const ReportRun& run, std::string_view topic) {
  Curve out;
  const autopilot::Route route = route_of(run);
  const Curves p = vector_of(run, topic, "p_NB_N");
  const Curve reached = curve_of(run, kTrajectory, "reached");
  if (route.waypoints.empty() || p[0].empty() || p[1].empty() || p[2].empty() || reached.empty()) return out;
  const auto all = static_cast<double>(route.waypoints.size());
  std::size_t next = 0;
  for (std::size_t k = 0; k < p[0].time.size(); ++k) {
    while (next + 1 < reached.time.size() && reached.time[next + 1] <= p[0].time[k]) ++next;
    const double count = reached.value[next];
    if (count < 1.0 || (!route.cyclic && count >= all)) continue;
    out.time.push_back(p[0].time[k]);
    out.value.push_back(to_polyline({p[0].value[k], p[1].value[k], p[2].value[k]}, route).norm());
  }
  return out;
}

}  // namespace ironbird::scenarios
