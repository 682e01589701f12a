#include "scenarios/report/figures.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/config/degrees.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/report/flight_data.hpp"

namespace ironbird::scenarios {

namespace {

/// The parts that a curve can play.
enum class Role { kCommand, kEstimate, kTruth };

std::string name_of(Role role) {
  if (role == Role::kCommand) return "command";
  return role == Role::kEstimate ? "estimate" : "truth";
}

/// Style of one curve: by role when there is one run, by run when there are several.
std::string style_of(Role role, std::size_t run, std::size_t runs) {
  if (runs == 1)
    return role == Role::kCommand ? "command plain" : role == Role::kEstimate ? "c0" : "c1 under";
  const std::string colour = "c" + std::to_string(run % 8);
  return colour + (role == Role::kCommand ? " command" : role == Role::kEstimate ? " dashed" : "");
}

std::string label_of(Role role, const ReportRun& run, std::size_t runs) {
  return runs == 1 ? name_of(role) : run.label() + " " + name_of(role);
}

/// Collects the curves of one panel.
class PanelMaker {
 public:
  PanelMaker(const std::vector<ReportRun>& runs, std::string title, std::string unit, double least_span)
      : runs_(runs) {
    panel_.title = std::move(title);
    panel_.unit = std::move(unit);
    panel_.least_span = least_span;
  }

  void add(Role role, std::size_t run, Curve curve, std::string_view topic) {
    add(label_of(role, runs_[run], runs_.size()), style_of(role, run, runs_.size()), std::move(curve), topic);
  }
  void add(std::string name, std::string style, Curve curve, std::string_view topic) {
    if (curve.empty()) {
      missing_.emplace_back(topic);
      return;
    }
    // A command that was never given has no place in the legend.
    if (std::none_of(curve.value.begin(), curve.value.end(), [](double v) { return std::isfinite(v); }))
      return;
    panel_.series.push_back(
        {std::move(name), std::move(style), std::move(curve.time), std::move(curve.value)});
  }
  void add_bound(std::size_t run, const Curve& sigma) {
    constexpr double kSigmas = 3.0;
    if (sigma.empty()) return;
    plot::Strip strip{runs_.size() == 1 ? "3\u03c3" : "",
                      "c" + std::to_string(run % 8) + (runs_.size() == 1 ? "" : " several"),
                      sigma.time,
                      {},
                      {}};
    strip.high = scaled(sigma, kSigmas).value;
    strip.low = scaled(sigma, -kSigmas).value;
    panel_.strips.push_back(std::move(strip));
  }

  /// What the panel says when it stays empty although the log has what it is made of.
  void when_empty(std::string reason) { empty_ = std::move(reason); }

  plot::Panel done() && {
    if (panel_.series.empty()) panel_.strips.clear();
    std::sort(missing_.begin(), missing_.end());
    missing_.erase(std::unique(missing_.begin(), missing_.end()), missing_.end());
    panel_.missing = missing_.empty() ? "it was never known" : "not in the log:";
    for (const std::string& topic : missing_) panel_.missing += " " + topic;
    if (!empty_.empty()) panel_.missing = empty_;
    return std::move(panel_);
  }

 private:
  const std::vector<ReportRun>& runs_;
  plot::Panel panel_;
  std::vector<std::string> missing_;
  std::string empty_;
};

/// @param setpoints  what an operator's setpoint calls this axis
plot::Panel axis_panel(const std::vector<ReportRun>& runs, const char* title, const std::string& suffix,
                       const std::vector<std::string>& setpoints) {
  PanelMaker maker(runs, title, "m", 0.5);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    maker.add(Role::kCommand, i, command_of(runs[i], "p_N" + suffix, setpoints), kTrajectoryTopic);
    maker.add(Role::kTruth, i, curve_of(runs[i], kTruthTopic, "p_NB_N" + suffix), kTruthTopic);
    maker.add(Role::kEstimate, i, estimate_of(runs[i], "p_NB_N" + suffix), kEstimateTopic);
  }
  return std::move(maker).done();
}

Curve degrees(const Curve& curve) {
  return scaled(curve, kDegreesPerRadian);
}

plot::Panel heading_panel(const std::vector<ReportRun>& runs) {
  PanelMaker maker(runs, "heading", "deg", 4.0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    maker.add(Role::kCommand, i, broken_at_wraps(degrees(command_of(runs[i], "heading", {"heading"}))),
              kTrajectoryTopic);
    maker.add(Role::kTruth, i, broken_at_wraps(degrees(angles_of(runs[i], kTruthTopic, "q_NB")[2])),
              kTruthTopic);
    maker.add(Role::kEstimate, i, broken_at_wraps(degrees(estimate_of(runs[i], "heading"))), kEstimateTopic);
  }
  return std::move(maker).done();
}

plot::Panel tilt_panel(const std::vector<ReportRun>& runs, const char* name, std::size_t axis) {
  PanelMaker maker(runs, name, "deg", 2.0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    maker.add(Role::kCommand, i, degrees(setpoint_of(runs[i], {name})), kSetpointTopic);
    maker.add(Role::kTruth, i, degrees(angles_of(runs[i], kTruthTopic, "q_NB")[axis]), kTruthTopic);
    maker.add(Role::kEstimate, i, degrees(estimate_of(runs[i], name)), kEstimateTopic);
  }
  return std::move(maker).done();
}

/// The length of a vector. @param axis  gives the curve of each of its axes
template <class AxisOf>
Curve length_of(const AxisOf& axis) {
  Curve out = axis(".x");
  const Curve y = axis(".y"), z = axis(".z");
  if (y.value.size() != out.value.size() || z.value.size() != out.value.size()) return {};
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    out.value[i] = std::sqrt(out.value[i] * out.value[i] + y.value[i] * y.value[i] + z.value[i] * z.value[i]);
  }
  return out;
}

plot::Panel speed_panel(const std::vector<ReportRun>& runs) {
  PanelMaker maker(runs, "speed", "m/s", 0.5);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ReportRun& run = runs[i];
    const auto command = [&](const std::string& axis) { return trajectory_of(run, "v_N" + axis); };
    const auto truth = [&](const std::string& axis) { return curve_of(run, kTruthTopic, "v_NB_N" + axis); };
    const auto estimate = [&](const std::string& axis) { return estimate_of(run, "v_NB_B" + axis); };
    maker.add(Role::kCommand, i, length_of(command), kTrajectoryTopic);
    maker.add(Role::kTruth, i, length_of(truth), kTruthTopic);
    maker.add(Role::kEstimate, i, length_of(estimate), kEstimateTopic);
  }
  return std::move(maker).done();
}

struct ErrorAxis {
  const char* title;
  const char* sigma;
};

plot::TimeStack error_stack(const std::vector<ReportRun>& runs, const char* title, const char* unit,
                            double factor, double least_span, Curves (*errors)(const ReportRun&),
                            const std::array<ErrorAxis, 3>& axes) {
  plot::TimeStack stack{title, {}, 372.0, 104.0};
  std::vector<Curves> found;
  for (const ReportRun& run : runs) found.push_back(errors(run));
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    PanelMaker maker(runs, axes[axis].title, unit, least_span);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      maker.add_bound(i, scaled(estimate_of(runs[i], axes[axis].sigma), factor));
      maker.add(runs.size() == 1 ? "error" : runs[i].label(), "c" + std::to_string(i % 8),
                scaled(found[i][axis], factor), std::string(kTruthTopic) + ", " + kEstimateTopic);
    }
    stack.panels.push_back(std::move(maker).done());
  }
  return stack;
}

bool is_used(const Curve& curve) {
  return std::any_of(curve.value.begin(), curve.value.end(),
                     [](double v) { return std::isfinite(v) && v != 0.0; });
}

plot::Panel rotor_panel(const std::vector<ReportRun>& runs, const char* title, const char* unit,
                        const char* topic, const std::string& field, double least_span) {
  constexpr std::size_t kMostRotors = 8;
  PanelMaker maker(runs, title, unit, least_span);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    bool any = false;
    for (std::size_t rotor = 0; rotor < kMostRotors; ++rotor) {
      Curve curve = curve_of(runs[i], topic, field + "[" + std::to_string(rotor) + "]");
      if (!is_used(curve)) continue;
      any = true;
      const std::string name = runs.size() == 1 ? std::to_string(rotor + 1)
                               : rotor == 0     ? runs[i].label()
                                                : "";
      maker.add(name, "thin c" + std::to_string(runs.size() == 1 ? rotor : i % 8), std::move(curve), topic);
    }
    // A log that has the field says that nothing turned; one without it says nothing.
    if (any) continue;
    if (curve_of(runs[i], topic, field + "[0]").empty()) {
      maker.add("", "", {}, topic);
    } else {
      maker.when_empty("it was zero all the time");
    }
  }
  return std::move(maker).done();
}

plot::Panel battery_panel(const std::vector<ReportRun>& runs, const char* title, const char* unit,
                          const char* field, double least_span) {
  PanelMaker maker(runs, title, unit, least_span);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Curve curve = curve_of(runs[i], kTruthTopic, field);
    const std::string name = runs.size() == 1 ? "" : runs[i].label();
    if (!curve.empty() && !is_used(curve)) {
      maker.when_empty("it was zero all the time");
      continue;
    }
    maker.add(name, "c" + std::to_string(i % 8), std::move(curve), kTruthTopic);
  }
  return std::move(maker).done();
}

plot::Track track_of(const ReportRun& run, Role role, std::size_t index, std::size_t runs) {
  plot::Track track{label_of(role, run, runs), style_of(role, index, runs), {}};
  const auto axis = [&](const char* field) {
    return role == Role::kTruth ? curve_of(run, kTruthTopic, field) : estimate_of(run, field);
  };
  const Curve north = axis("p_NB_N.x"), east = axis("p_NB_N.y");
  for (std::size_t k = 0; k < std::min(north.value.size(), east.value.size()); ++k)
    track.points.push_back({east.value[k], north.value[k]});
  return track;
}

}  // namespace

plot::Plane path_from_above(const std::vector<ReportRun>& runs) {
  plot::Plane plane{
      "Path from above", "east", "north", "m", {}, {}, "not in the log: /truth/state, /autopilot/estimate"};
  std::vector<std::array<double, 3>> waypoints;
  if (!runs.empty()) waypoints = waypoints_of(runs.front());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    plane.places.push_back({std::to_string(i + 1), {waypoints[i][1], waypoints[i][0]}});
  }
  plot::Track planned{"planned", "command plain", {}};
  for (const plot::Place& place : plane.places) planned.points.push_back(place.point);
  if (!planned.points.empty() && is_cyclic(runs.front())) planned.points.push_back(planned.points.front());
  if (!planned.points.empty()) plane.tracks.push_back(std::move(planned));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const Role role : {Role::kTruth, Role::kEstimate}) {
      plot::Track track = track_of(runs[i], role, i, runs.size());
      if (!track.points.empty()) plane.tracks.push_back(std::move(track));
    }
  }
  return plane;
}

plot::TimeStack position_and_heading(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Position and heading against command", {}, 780.0, 112.0};
  stack.panels.push_back(axis_panel(runs, "north", ".x", {"p_N.x"}));
  stack.panels.push_back(axis_panel(runs, "east", ".y", {"p_N.y"}));
  stack.panels.push_back(axis_panel(runs, "down", ".z", {"p_N.z", "down"}));
  stack.panels.push_back(heading_panel(runs));
  return stack;
}

plot::TimeStack attitude_and_speed(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Attitude and speed", {}, 1180.0, 100.0};
  stack.panels.push_back(tilt_panel(runs, "roll", 0));
  stack.panels.push_back(tilt_panel(runs, "pitch", 1));
  stack.panels.push_back(speed_panel(runs));
  return stack;
}

plot::TimeStack path_errors(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Distance from the planned path", {}, 1180.0, 120.0};
  PanelMaker maker(runs, "distance to the waypoints' polyline, first to last waypoint", "m", 0.02);
  const bool flew = std::any_of(runs.begin(), runs.end(), [](const ReportRun& run) {
    return !run.time(kTrajectoryTopic).empty() && !run.time(kEstimateTopic).empty();
  });
  // A flight without waypoints has a log without a route, and nothing is missing from it.
  if (flew) maker.when_empty("no leg between two waypoints was flown");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::string needed = ", /autopilot/route, /autopilot/trajectory";
    maker.add(Role::kTruth, i, path_distance(runs[i], kTruthTopic), kTruthTopic + needed);
    maker.add(Role::kEstimate, i, path_distance(runs[i], kEstimateTopic), kEstimateTopic + needed);
  }
  stack.panels.push_back(std::move(maker).done());
  return stack;
}

plot::TimeStack position_errors(const std::vector<ReportRun>& runs) {
  return error_stack(runs, "Position error", "m", 1.0, 0.02, position_error,
                     {{{"north", "sigma_p_N.x"}, {"east", "sigma_p_N.y"}, {"down", "sigma_p_N.z"}}});
}

plot::TimeStack velocity_errors(const std::vector<ReportRun>& runs) {
  return error_stack(runs, "Velocity error", "m/s", 1.0, 0.01, velocity_error,
                     {{{"forward", "sigma_v_B.x"}, {"right", "sigma_v_B.y"}, {"down", "sigma_v_B.z"}}});
}

plot::TimeStack attitude_errors(const std::vector<ReportRun>& runs) {
  return error_stack(
      runs, "Attitude error", "deg", kDegreesPerRadian, 0.05, attitude_error,
      {{{"roll", "sigma_attitude.x"}, {"pitch", "sigma_attitude.y"}, {"heading", "sigma_attitude.z"}}});
}

plot::TimeStack motors_and_battery(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Motors and battery", {}, 1180.0, 100.0};
  stack.panels.push_back(rotor_panel(runs, "motor outputs", "0 to 1", kOutputTopic, "values", 0.05));
  stack.panels.push_back(rotor_panel(runs, "rotor speeds", "rad/s", kTruthTopic, "rotor_speed", 20.0));
  stack.panels.push_back(battery_panel(runs, "battery voltage", "V", "battery_voltage", 0.5));
  stack.panels.push_back(battery_panel(runs, "battery current", "A", "battery_current", 2.0));
  return stack;
}

}  // namespace ironbird::scenarios
