#include "scenarios/report/replay_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "scenarios/config/degrees.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/report/flight_data.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kRecordedStyle = "command plain";
constexpr const char* kFixStyle = "c7 dots";

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

/// Since when there is an estimate, s; never: infinite.
double ready_time(const ReportRun& run) {
  const Curve since = estimate_of(run, "p_NB_N.x");
  for (std::size_t k = 0; k < since.time.size(); ++k) {
    if (std::isfinite(since.value[k])) return since.time[k];
  }
  return std::numeric_limits<double>::infinity();
}

/// What the estimator tells of itself, since there is an estimate.
Curve probed(const ReportRun& run, const std::string& field, double factor = 1.0) {
  const double ready = ready_time(run);
  const Curve all = scaled(curve_of(run, probe_of(run), field), factor);
  Curve out;
  for (std::size_t k = 0; k < all.time.size(); ++k) {
    if (all.time[k] < ready) continue;
    out.time.push_back(all.time[k]);
    out.value.push_back(all.value[k]);
  }
  return out;
}

Curve sum_of(Curve one, const Curve& other) {
  for (std::size_t k = 0; k < std::min(one.value.size(), other.value.size()); ++k)
    one.value[k] += other.value[k];
  return one;
}

/// The values at the times from one to the next of which `count` grew.
Curve where_it_grew(const Curve& values, const Curve& count) {
  Curve out;
  for (std::size_t k = 1; k < std::min(values.value.size(), count.value.size()); ++k) {
    if (!(count.value[k] > count.value[k - 1])) continue;
    out.time.push_back(values.time[k]);
    out.value.push_back(values.value[k]);
  }
  return out;
}

/// A measurement, one axis of it, and the gate that it has to pass.
struct Gated {
  const char* title;
  const char* unit;
  const char* innovation;
  const char* gate;
  const char* rejected;
  double factor;
  double least_span;
};
constexpr std::array<Gated, 8> kGated{
    {{"fix, north", "m", "innovation_position_x", "gate_position_x", "rejected_position", 1.0, 0.1},
     {"fix, east", "m", "innovation_position_y", "gate_position_y", "rejected_position", 1.0, 0.1},
     {"fix, down", "m", "innovation_position_z", "gate_position_z", "rejected_position", 1.0, 0.1},
     {"fix, velocity north", "m/s", "innovation_velocity_x", "gate_velocity_x", "rejected_velocity", 1.0,
      0.1},
     {"fix, velocity east", "m/s", "innovation_velocity_y", "gate_velocity_y", "rejected_velocity", 1.0, 0.1},
     {"fix, velocity down", "m/s", "innovation_velocity_z", "gate_velocity_z", "rejected_velocity", 1.0, 0.1},
     {"barometer", "Pa", "innovation_pressure", "gate_pressure", "rejected_baro", 1.0, 1.0},
     {"compass", "deg", "innovation_heading", "gate_heading", "rejected_mag", kDegreesPerRadian, 1.0}}};

/// "gate 8.2 to 8.9", the range of a gate that is there.
std::string gate_text(const Curve& gate) {
  const auto [low, high] = std::minmax_element(gate.value.begin(), gate.value.end());
  const std::string from = short_number(*low);
  const std::string to = short_number(*high);
  return "gate \u00b1" + (from == to ? from : from + " to " + to);
}

/// The gate's line on one side; gaps where there is none.
Curve side(Curve gate, double sign) {
  for (double& value : gate.value) value = value > 0.0 ? sign * value : kNoNumber;
  return gate;
}

/// One of several runs has its name; of one the thing alone is named.
std::string named(const std::vector<ReportRun>& runs, std::size_t i, const std::string& what) {
  return runs.size() == 1 ? what : what + ", " + runs[i].label();
}

void add_gated(plot::Panel& panel, const std::vector<ReportRun>& runs, std::size_t i, const Gated& row) {
  const Curve innovation = probed(runs[i], row.innovation, row.factor);
  const Curve gate = probed(runs[i], row.gate, row.factor);
  const Curve judged = side(gate, 1.0);
  if (without_gaps(judged).empty()) return;  // nobody judges this axis
  panel.title += (panel.series.empty() ? ": " : "; ") + named(runs, i, gate_text(without_gaps(judged)));
  for (const double sign : {1.0, -1.0}) {
    const Curve line = side(gate, sign);
    panel.bounds.push_back({named(runs, i, "gate"), colour(i) + " bound", line.time, line.value});
  }
  add(panel, runs.size() == 1 ? "innovation" : runs[i].label(), colour(i), innovation);
  add(panel, "refused", "refused dots", where_it_grew(innovation, probed(runs[i], row.rejected)));
}

/// What is found of one axis of a sensor, within three sigmas where they are told.
struct Bias {
  const char* title;
  const char* unit;
  std::array<const char*, 2> parts;  ///< fields that add up; empty: one only
  const char* sigma;
  double factor;
  double least_span;
};
constexpr std::array<Bias, 3> kBiases{
    {{"gyro", "deg/s", {"gyro_bias", ""}, "sigma_gyro_bias", kDegreesPerRadian, 0.01},
     {"accelerometer",
      "m/s^2",
      {"accelerometer_offset", "accelerometer_bias"},
      "sigma_accelerometer_bias",
      1.0,
      0.01},
     {"compass, share of the field", "1", {"mag_bias", ""}, "sigma_mag_bias", 1.0, 0.01}}};

void add_bias(plot::Panel& panel, const std::vector<ReportRun>& runs, std::size_t i, const Bias& bias,
              const std::string& axis) {
  constexpr double kSigmas = 3.0;
  Curve found = probed(runs[i], bias.parts[0] + axis, bias.factor);
  if (*bias.parts[1] != '\0') found = sum_of(found, probed(runs[i], bias.parts[1] + axis, bias.factor));
  const Curve sigma = probed(runs[i], bias.sigma + axis, kSigmas * bias.factor);
  const bool is_sought = !sigma.empty() || std::any_of(found.value.begin(), found.value.end(),
                                                       [](double value) { return value != 0.0; });
  if (found.empty() || !is_sought) return;
  if (!sigma.empty()) {
    panel.strips.push_back({runs.size() == 1 ? "3\u03c3" : "",
                            colour(i) + (runs.size() == 1 ? "" : " several"), sigma.time,
                            sum_of(scaled(sigma, -1.0), found).value, sum_of(sigma, found).value});
  }
  add(panel, label(runs, i), colour(i), found);
}

}  // namespace

bool is_replay(const ReportRun& run) {
  return run.log().topic(kRecordedPositionTopic) != nullptr ||
         run.log().topic(kRecordedAttitudeTopic) != nullptr ||
         run.log().topic(kRecordedFixTopic) != nullptr || run.log().topic(kRecordedPhaseTopic) != nullptr;
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
  const Curve known = curve_of(first, kRecordedPositionTopic, "position_known");
  track(recorded_name(first), kRecordedStyle,
        where(curve_of(first, kRecordedPositionTopic, "p_NB_N.x"), known),
        where(curve_of(first, kRecordedPositionTopic, "p_NB_N.y"), known));
  track("fixes", kFixStyle, curve_of(first, kRecordedFixTopic, "p_N.x"),
        curve_of(first, kRecordedFixTopic, "p_N.y"));
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
    add(panel, recorded_name(first), kRecordedStyle,
        where(curve_of(first, kRecordedPositionTopic, field),
              curve_of(first, kRecordedPositionTopic, known)));
    add(panel, "fixes", kFixStyle, curve_of(first, kRecordedFixTopic, std::string("p_N") + axis.suffix));
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
    add(panel, recorded_name(first), kRecordedStyle,
        where(curve_of(first, kRecordedPositionTopic, std::string("v_NB_N") + kAxes[k].suffix),
              curve_of(first, kRecordedPositionTopic, "velocity_known")));
    add(panel, "fixes", kFixStyle, curve_of(first, kRecordedFixTopic, std::string("v_N") + kAxes[k].suffix));
    for (std::size_t i = 0; i < runs.size(); ++i) add(panel, label(runs, i), colour(i), ours[i][k]);
    stack.panels.push_back(std::move(panel));
  }
  return stack;
}

plot::TimeStack replayed_attitude(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Attitude", {}, 1180.0, 100.0};
  const Curves recorded = angles_of(runs.front(), kRecordedAttitudeTopic, "q_NB");
  constexpr std::array<const char*, 3> kNames{"roll", "pitch", "heading"};
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    plot::Panel panel = panel_of(kNames[k], "deg", k == 2 ? 4.0 : 2.0);
    add(panel, recorded_name(runs.front()), kRecordedStyle,
        broken_at_wraps(scaled(recorded[k], kDegreesPerRadian)));
    for (std::size_t i = 0; i < runs.size(); ++i)
      add(panel, label(runs, i), colour(i),
          broken_at_wraps(scaled(estimate_of(runs[i], kNames[k]), kDegreesPerRadian)));
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
  constexpr std::array<Row, 9> kRows{
      {{"north", "m", "p_N.x", "sigma_p_N.x", 1.0, 0.02},
       {"east", "m", "p_N.y", "sigma_p_N.y", 1.0, 0.02},
       {"down", "m", "p_N.z", "sigma_p_N.z", 1.0, 0.02},
       {"velocity north", "m/s", "v_N.x", nullptr, 1.0, 0.02},
       {"velocity east", "m/s", "v_N.y", nullptr, 1.0, 0.02},
       {"velocity down", "m/s", "v_N.z", nullptr, 1.0, 0.02},
       {"roll", "deg", "theta.x", "sigma_attitude.x", kDegreesPerRadian, 0.1},
       {"pitch", "deg", "theta.y", "sigma_attitude.y", kDegreesPerRadian, 0.1},
       {"heading", "deg", "theta.z", "sigma_attitude.z", kDegreesPerRadian, 0.1}}};
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
          without_gaps(scaled(curve_of(runs[i], kDifferenceTopic, row.field), row.factor)));
    }
    if (panel.series.empty()) panel.strips.clear();
    stack.panels.push_back(std::move(panel));
  }
  return stack;
}

plot::TimeStack replayed_innovations(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{
      "Innovations: measured less expected, the gate that each has to pass, and what was refused",
      {},
      1180.0,
      84.0};
  for (const Gated& row : kGated) {
    plot::Panel panel = panel_of(row.title, row.unit, row.least_span);
    for (std::size_t i = 0; i < runs.size(); ++i) add_gated(panel, runs, i, row);
    if (!panel.series.empty()) stack.panels.push_back(std::move(panel));
  }
  if (stack.panels.empty()) stack.panels.push_back(panel_of("innovations", "", 1.0));
  return stack;
}

plot::TimeStack replayed_biases(const std::vector<ReportRun>& runs) {
  plot::TimeStack stack{"Biases that were found", {}, 1180.0, 84.0};
  for (const Bias& bias : kBiases) {
    for (const auto& [axis, suffix] :
         {std::pair("front", "_x"), std::pair("right", "_y"), std::pair("down", "_z")}) {
      plot::Panel panel = panel_of(std::string(bias.title) + ", " + axis, bias.unit, bias.least_span);
      for (std::size_t i = 0; i < runs.size(); ++i) add_bias(panel, runs, i, bias, suffix);
      if (!panel.series.empty()) stack.panels.push_back(std::move(panel));
    }
  }
  if (stack.panels.empty()) stack.panels.push_back(panel_of("biases", "", 1.0));
  return stack;
}

}  // namespace ironbird::scenarios
