#include "scenarios/report/replay_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "scenarios/config/degrees.hpp"
#include "scenarios/report/flight_data.hpp"
#include "scenarios/report/topics.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kAttitude = "/recorded/attitude";
constexpr const char* kPosition = "/recorded/position";
constexpr const char* kFix = "/recorded/fix";
constexpr const char* kDifference = "/compared/difference";
constexpr const char* kRecordedStyle = "command plain";
constexpr const char* kFixStyle = "c7 dotted";

struct Axis {
  const char* title;
  const char* suffix;
};
constexpr std::array<Axis, 3> kAxes{{{"north", ".x"}, {"east", ".y"}, {"down", ".z"}}};

std::string colour(std::size_t run) {
  return "c" + std::to_string(run % 8);
}

std::string label(const std::vector<ReportRun>& runs, std::size_t i) {
  return runs.size() == 1 ? "ours" : runs[i].label();
}

/// Whose the recorded estimate is.
std::string recorded_name(const ReportRun& run) {
  const std::string name = run.about("recorded");
  return name.empty() ? "recorded" : name;
}

/// A curve with gaps where `known` is not 1.
Curve where(Curve curve, const Curve& known) {
  for (std::size_t k = 0; k < std::min(curve.value.size(), known.value.size()); ++k) {
    if (known.value[k] != 1.0) curve.value[k] = kNoNumber;
  }
  return curve;
}

/// Without the values that are no numbers: messages of another kind between those that are wanted.
Curve without_gaps(const Curve& curve) {
  Curve out;
  for (std::size_t k = 0; k < curve.time.size(); ++k) {
    if (!std::isfinite(curve.value[k])) continue;
    out.time.push_back(curve.time[k]);
    out.value.push_back(curve.value[k]);
  }
  return out;
}

void add(plot::Panel& panel, std::string name, std::string style, Curve curve) {
  if (curve.empty()) return;
  panel.series.push_back({std::move(name), std::move(style), std::move(curve.time), std::move(curve.value)});
}

plot::Panel panel_of(std::string title, std::string unit, double least_span) {
  plot::Panel panel;
  panel.title = std::move(title);
  panel.unit = std::move(unit);
  panel.least_span = least_span;
  panel.missing = "not in the log";
  return panel;
}

/// The velocity of the estimate in N.
Curves velocity_of(const ReportRun& run) {
  Curves out;
  std::array<std::vector<double>, 3> v_B{run.column(kEstimateTopic, "v_NB_B.x"),
                                         run.column(kEstimateTopic, "v_NB_B.y"),
                                         run.column(kEstimateTopic, "v_NB_B.z")};
  std::array<std::vector<double>, 4> q{
      run.column(kEstimateTopic, "q_NB.w"), run.column(kEstimateTopic, "q_NB.x"),
      run.column(kEstimateTopic, "q_NB.y"), run.column(kEstimateTopic, "q_NB.z")};
  const Curve since = estimate_of(run, "p_NB_N.x");
  for (std::size_t k = 0; k < std::min(since.time.size(), q[3].size()); ++k) {
    const Eigen::Vector3d v_N = Eigen::Quaterniond(q[0][k], q[1][k], q[2][k], q[3][k]) *
                                Eigen::Vector3d(v_B[0][k], v_B[1][k], v_B[2][k]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out[axis].time.push_back(since.time[k]);
      out[axis].value.push_back(std::isfinite(since.value[k]) ? v_N(static_cast<int>(axis)) : kNoNumber);
    }
  }
  return out;
}

std::string probe_of(const ReportRun& run) {
  for (const std::string& topic : run.log().topics()) {
    if (topic.starts_with("/autopilot/estimator/") && topic.ends_with("/probe")) return topic;
  }
  return {};
}

plot::Panel probe_panel(const std::vector<ReportRun>& runs, std::string title, std::string unit,
                        double factor, const std::string& field, double least_span) {
  plot::Panel panel = panel_of(std::move(title), std::move(unit), least_span);
  for (std::size_t i = 0; i < runs.size(); ++i)
    add(panel, label(runs, i), colour(i), scaled(curve_of(runs[i], probe_of(runs[i]), field), factor));
  return panel;
}

}  // namespace

bool is_replay(const ReportRun& run) {
  return run.log().topic(kPosition) != nullptr || run.log().topic(kAttitude) != nullptr ||
         run.log().topic(kFix) != nullptr;
}

plot::Plane replayed_path(const std::vector<ReportRun>& runs) {
  plot::Plane plane{"Path from above", "east", "north", "m", {}, {}, "nothing was estimated"};
  const auto track = [&](std::string name, std::string style, const Curve& north, const Curve& east) {
    plot::Track found{std::move(name), std::move(style), {}};
    for (std::size_t k = 0; k < std::min(north.value.size(), east.value.size()); ++k)
      found.points.push_back({east.value[k], north.value[k]});
    if (!found.points.empty()) plane.tracks.push_back(std::move(found));
  };
  const ReportRun& first = runs.front();
  track("fixes", kFixStyle, curve_of(first, kFix, "p_N.x"), curve_of(first, kFix, "p_N.y"));
  const Curve known = curve_of(first, kPosition, "position_known");
  track(recorded_name(first), kRecordedStyle, where(curve_of(first, kPosition, "p_NB_N.x"), known),
        where(curve_of(first, kPosition, "p_NB_N.y"), known));
  for (std::size_t i = 0; i < runs.size(); ++i)
    track(label(runs, i), colour(i), estimate_of(runs[i], "p_NB_N.x"), estimate_of(runs[i], "p_NB_N.y"));
  return plane;
}

plot::TimeStack replayed_position(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Position", {}, 780.0, 112.0};
  const ReportRun& first = runs.front();
  for (const Axis& axis : kAxes) {
    plot::Panel panel = panel_of(axis.title, "m", 0.5);
    const std::string field = std::string("p_NB_N") + axis.suffix;
    const char* const known = axis.suffix == kAxes[2].suffix ? "height_known" : "position_known";
    add(panel, "fixes", kFixStyle, curve_of(first, kFix, std::string("p_N") + axis.suffix));
    add(panel, recorded_name(first), kRecordedStyle,
        where(curve_of(first, kPosition, field), curve_of(first, kPosition, known)));
    for (std::size_t i = 0; i < runs.size(); ++i)
      add(panel, label(runs, i), colour(i), estimate_of(runs[i], field));
    stack.panels.push_back(std::move(panel));
  }
  return stack;
}

plot::TimeStack replayed_velocity(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Velocity", {}, 1180.0, 100.0};
  const ReportRun& first = runs.front();
  std::vector<Curves> ours;
  for (const ReportRun& run : runs) ours.push_back(velocity_of(run));
  for (std::size_t k = 0; k < kAxes.size(); ++k) {
    plot::Panel panel = panel_of(kAxes[k].title, "m/s", 0.5);
    add(panel, "fixes", kFixStyle, curve_of(first, kFix, std::string("v_N") + kAxes[k].suffix));
    add(panel, recorded_name(first), kRecordedStyle,
        where(curve_of(first, kPosition, std::string("v_NB_N") + kAxes[k].suffix),
              curve_of(first, kPosition, "velocity_known")));
    for (std::size_t i = 0; i < runs.size(); ++i) add(panel, label(runs, i), colour(i), ours[i][k]);
    stack.panels.push_back(std::move(panel));
  }
  return stack;
}

plot::TimeStack replayed_attitude(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Attitude", {}, 1180.0, 100.0};
  const Curves recorded = angles_of(runs.front(), kAttitude, "q_NB");
  constexpr std::array<const char*, 3> kNames{"roll", "pitch", "heading"};
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    plot::Panel panel = panel_of(kNames[k], "deg", k == 2 ? 4.0 : 2.0);
    add(panel, recorded_name(runs.front()), kRecordedStyle, broken_at_wraps(scaled(recorded[k], kDegrees)));
    for (std::size_t i = 0; i < runs.size(); ++i)
      add(panel, label(runs, i), colour(i),
          broken_at_wraps(scaled(estimate_of(runs[i], kNames[k]), kDegrees)));
    stack.panels.push_back(std::move(panel));
  }
  return stack;
}

plot::TimeStack replayed_differences(const std::vector<ReportRun>& runs) {
  struct Row {
    const char* title;
    const char* unit;
    const char* field;
    const char* sigma;
    double factor;
    double least_span;
  };
  constexpr std::array<Row, 9> kRows{{{"north", "m", "p_N.x", "sigma_p_N.x", 1.0, 0.02},
                                      {"east", "m", "p_N.y", "sigma_p_N.y", 1.0, 0.02},
                                      {"down", "m", "p_N.z", "sigma_p_N.z", 1.0, 0.02},
                                      {"velocity north", "m/s", "v_N.x", nullptr, 1.0, 0.02},
                                      {"velocity east", "m/s", "v_N.y", nullptr, 1.0, 0.02},
                                      {"velocity down", "m/s", "v_N.z", nullptr, 1.0, 0.02},
                                      {"roll", "deg", "theta.x", "sigma_attitude.x", kDegrees, 0.1},
                                      {"pitch", "deg", "theta.y", "sigma_attitude.y", kDegrees, 0.1},
                                      {"heading", "deg", "theta.z", "sigma_attitude.z", kDegrees, 0.1}}};
  plot::TimeStack stack{"Ours less the recorded one", {}, 1180.0, 84.0};
  for (const Row& row : kRows) {
    plot::Panel panel = panel_of(row.title, row.unit, row.least_span);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      constexpr double kSigmas = 3.0;
      const Curve sigma =
          row.sigma == nullptr ? Curve{} : scaled(estimate_of(runs[i], row.sigma), kSigmas * row.factor);
      if (!sigma.empty()) {
        panel.strips.push_back({runs.size() == 1 ? "3\u03c3" : "",
                                colour(i) + (runs.size() == 1 ? "" : " several"), sigma.time,
                                scaled(sigma, -1.0).value, sigma.value});
      }
      add(panel, label(runs, i), colour(i),
          without_gaps(scaled(curve_of(runs[i], kDifference, row.field), row.factor)));
    }
    if (panel.series.empty()) panel.strips.clear();
    stack.panels.push_back(std::move(panel));
  }
  return stack;
}

plot::TimeStack replayed_innovations(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{
      "How the measurements fitted: normalised innovations squared, and how many were refused so far",
      {},
      1180.0,
      84.0};
  constexpr std::array<std::pair<const char*, const char*>, 4> kSensors{{{"fix, position", "position"},
                                                                         {"fix, velocity", "velocity"},
                                                                         {"barometer", "baro"},
                                                                         {"compass", "mag"}}};
  for (const auto& [title, name] : kSensors) {
    plot::Panel panel = probe_panel(runs, title, "1", 1.0, std::string("nis_") + name, 1.0);
    for (std::size_t i = 0; i < runs.size(); ++i)
      add(panel, "refused", colour(i) + " dashed",
          curve_of(runs[i], probe_of(runs[i]), std::string("rejected_") + name));
    stack.panels.push_back(std::move(panel));
  }
  return stack;
}

plot::TimeStack replayed_biases(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Biases that were found", {}, 1180.0, 84.0};
  for (const auto& [title, field, unit, factor] :
       std::initializer_list<std::tuple<const char*, const char*, const char*, double>>{
           {"gyro", "gyro_bias_B", "deg/s", kDegrees},
           {"accelerometer", "accelerometer_bias_B", "m/s^2", 1.0}}) {
    for (const auto& [axis, suffix] :
         {std::pair("front", ".x"), std::pair("right", ".y"), std::pair("down", ".z")}) {
      plot::Panel panel = panel_of(std::string(title) + ", " + axis, unit, 0.01);
      for (std::size_t i = 0; i < runs.size(); ++i)
        add(panel, label(runs, i), colour(i),
            scaled(estimate_of(runs[i], std::string(field) + suffix), factor));
      stack.panels.push_back(std::move(panel));
    }
  }
  return stack;
}

}  // namespace ironbird::scenarios
