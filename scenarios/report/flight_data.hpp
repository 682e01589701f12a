#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/report/report_run.hpp"

namespace ironbird::scenarios {

/// Numbers over time.
struct Curve {
  std::vector<double> time;   ///< s, rising
  std::vector<double> value;  ///< as many
  bool empty() const { return time.empty(); }
};

/// Three numbers over time.
using Curves = std::array<Curve, 3>;

/// What the log says about a column, with its times; empty when it says nothing.
Curve curve_of(const ReportRun& run, std::string_view topic, std::string_view field);

/// A column of the trajectory: a gap where the companion did not fly, for then nobody followed it. While it
/// waits, the trajectory says where the vehicle is.
Curve trajectory_of(const ReportRun& run, std::string_view field);

/// What the controller was asked for by one of these names, `roll` or `p_N.x`, at whichever of its entry
/// points: a gap where it was asked for no such thing, or not listened to.
Curve setpoint_of(const ReportRun& run, const std::vector<std::string>& names);

/// What the vehicle was told to follow: a column of the trajectory, or, while an operator's setpoint flew,
/// what that says by one of `names`. A gap where neither was.
Curve command_of(const ReportRun& run, std::string_view field, const std::vector<std::string>& names);

/// A column of the estimate: a gap before there was one.
Curve estimate_of(const ReportRun& run, std::string_view field);

/// Roll, pitch, heading of the quaternions `<field>.w` …, rad.
Curves angles_of(const ReportRun& run, std::string_view topic, const std::string& field);

/// `curve` at other times, linear in between, held beyond its ends. Empty when `curve` is.
Curve resampled(const Curve& curve, const std::vector<double>& time);

/// The same for angles, rad: the short way round in between.
Curve resampled_angle(const Curve& curve, const std::vector<double>& time);

/// Estimate less truth. Axes: position north, east, down, m; velocity forward, right, down, m/s; roll, pitch,
/// heading, rad. Empty where the log lacks one of the two.
Curves position_error(const ReportRun& run);
Curves velocity_error(const ReportRun& run);
Curves attitude_error(const ReportRun& run);

/// The position error down with which the estimate begins on the ground, m: it counts heights from where the
/// centre of mass stands, the truth from the ground. None when it does not begin there.
std::optional<double> height_apart(const ReportRun& run);

/// Multiplies every value.
Curve scaled(Curve curve, double factor);

/// Puts a gap where an angle jumps by more than half a turn, so that no line crosses the plot. Degrees.
Curve broken_at_wraps(Curve curve);

/// The points of the log's main_route() in N.
std::vector<std::array<double, 3>> waypoints_of(const ReportRun& run);

/// True when that route is cyclic.
bool is_cyclic(const ReportRun& run);

/// Distance of the points of a topic to the polyline of the waypoints in force at their time, from the first
/// waypoint reached until the last, m; broken where no waypoint was under way.
Curve path_distance(const ReportRun& run, std::string_view topic);

}  // namespace ironbird::scenarios
