#include "scenarios/report/test/synthetic_flight.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "scenarios/requirements/attitude.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::FlightPhase;
using Eigen::Vector3d;

const std::array<Vector3d, 3> kWaypoints{Vector3d(0.0, 0.0, -5.0), Vector3d(-20.0, 0.0, -8.0),
                                         Vector3d(-20.0, -20.0, -5.0)};
constexpr double kLegTime = 14.0;   // s
constexpr double kStart = 10.0;     // s: the first waypoint
constexpr double kHomeward = 41.0;  // s: the way home takes the mission's place

/// A smooth way from 0 to 1.
double smooth(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

/// A wobble that looks like noise and is the same on every machine to the digits drawn.
double wobble(double t, double pitch) {
  return 0.5 * std::sin(7.3 * t * pitch) + 0.3 * std::sin(17.9 * t * pitch + 1.0) +
         0.2 * std::sin(41.0 * t * pitch + 2.0);
}

Vector3d planned(double t) {
  if (t < kStart) return {0.0, 0.0, -5.0 * smooth((t - 2.0) / 7.0)};
  const double legs = std::min((t - kStart) / kLegTime, 2.0 - 1e-9);
  const auto leg = static_cast<std::size_t>(legs);
  const Vector3d place =
      kWaypoints[leg] + smooth(legs - static_cast<double>(leg)) * (kWaypoints[leg + 1] - kWaypoints[leg]);
  const double landing = t < 44.0 ? 0.0 : smooth((t - 44.0) / 12.0);
  return {place.x(), place.y(), place.z() * (1.0 - landing)};
}

FlightPhase phase_at(double t) {
  if (t < 2.0 || t > 57.0) return FlightPhase::kDisarmed;
  if (t < 9.0) return FlightPhase::kTakeOff;
  if (t < kStart) return FlightPhase::kHold;
  return t < 44.0 ? FlightPhase::kOffboard : FlightPhase::kLanding;
}

CheckConfig check(std::string name, std::string signal) {
  CheckConfig config;
  config.name = std::move(name);
  config.signal = std::move(signal);
  return config;
}

std::vector<CheckConfig> checks() {
  CheckConfig tube = check("stays near the planned path", "truth.p_NB_N");
  tube.stays_within_tube = "0.5 m";
  tube.after = "waypoint_1";
  tube.until = "route_finished";
  CheckConfig tilt = check("pitches gently", "autopilot.estimate.pitch");
  tilt.stays_within = BandConfig{"-12 deg", "12 deg"};
  CheckConfig heading = check("holds its heading", "");
  heading.error = {"truth.heading", "autopilot.trajectory.heading"};
  heading.rms_below = "2 deg";
  heading.after = "offboard";
  CheckConfig order = check("flies the phases in order", "");
  order.order_of_events = std::vector<std::string>{"take_off", "hold", "offboard", "landing", "disarmed"};
  CheckConfig path = check("path error as good as promised", "");
  path.metric = "path_rms_total_m";
  path.metric_below = "0.03";
  return {tube, tilt, heading, order, path};
}

}  // namespace

void SyntheticFlight::set(double t) {
  const Vector3d p = planned(t), before = planned(t - 0.01), after = planned(t + 0.01);
  const Vector3d v = (after - before) / 0.02, a = (after - 2.0 * p + before) / 1e-4;
  const bool flying = t > 2.0 && t < 57.0;
  const double airborne = flying ? 1.0 : 0.0;
  const double gust = 0.35 * std::exp(-std::pow((t - 31.0) / 1.2, 2.0));

  autopilot::TrajectoryPoint& trajectory = signals_.trajectory;
  trajectory.valid = flying;
  trajectory.p_N = p;
  trajectory.v_N = v;
  trajectory.heading = wrapped(2.4 + 0.9 * smooth((t - 12.0) / 10.0));
  trajectory.reached = t < kStart ? 0 : t < kStart + kLegTime ? 1 : t < kStart + 2.0 * kLegTime ? 2 : 3;
  trajectory.finished = trajectory.reached == 3;
  if (t >= kHomeward) {
    trajectory.reached = 0;
    trajectory.finished = false;
    signals_.route.waypoints.resize(waypoints_ ? 1 : 0);
  }

  truth_.p_NB_N =
      p + airborne * Vector3d(0.06 * wobble(t, 0.2), 0.05 * wobble(t, 0.17) + gust, 0.03 * wobble(t, 0.3));
  truth_.v_NB_N = v;
  const double heading = trajectory.heading + airborne * 0.02 * wobble(t, 0.4);
  const double pitch = std::clamp(-a.x() * 0.1, -0.3, 0.3),
               roll = std::clamp(-a.y() * 0.1, -0.3, 0.3) - gust * 0.4;
  truth_.q_NB = Eigen::AngleAxisd(heading, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
                Eigen::AngleAxisd(roll, Vector3d::UnitX());
  truth_.in_contact = !flying;
  for (std::size_t i = 0; i < 4; ++i) {
    truth_.rotor_speed[i] = airborne * (520.0 + 12.0 * wobble(t, 1.0 + 0.1 * static_cast<double>(i)));
    outputs_.values[i] = static_cast<float>(truth_.rotor_speed[i] / 900.0);
  }
  truth_.battery_voltage = 16.6 - 0.01 * t - airborne * 0.6;
  truth_.battery_current = airborne * (18.0 + wobble(t, 1.0));

  set_estimate(t, {roll, pitch, heading});
  signals_.flight.phase = phase_at(t);
  signals_.flight.fcu.armed = flying;
  autopilot::AngleHeadingRateThrust setpoint;
  setpoint.roll = roll + gust * 0.1;
  setpoint.pitch = pitch;
  if (flying) signals_.setpoint = setpoint;
  signals_.flight.operator_setpoint = operator_ && t >= 20.0 && t < 25.0;
  if (!signals_.flight.operator_setpoint) return;
  signals_.setpoint = autopilot::VelocityHeightHeadingRate{.down = -6.0};
  trajectory.p_N = signals_.estimate.p_NB_N;
}

void SyntheticFlight::set_estimate(double t, const EulerAngles& angles) {
  autopilot::StateEstimate& estimate = signals_.estimate;
  if (t < kEstimatorBegins) return;
  estimate.health = autopilot::Health::kGood;
  estimate.p_NB_N = truth_.p_NB_N + Vector3d(0.03 * wobble(t, 0.11), offset_east_ + 0.02 * wobble(t, 0.13),
                                             0.04 * wobble(t, 0.09));
  estimate.v_NB_B = truth_.q_NB.conjugate() * truth_.v_NB_N +
                    0.012 * Vector3d(wobble(t, 1.1), wobble(t, 1.2), wobble(t, 1.3));
  estimate.roll = angles.roll + 0.002 * wobble(t, 0.9);
  estimate.pitch = angles.pitch + 0.002 * wobble(t, 0.8);
  estimate.heading = wrapped(angles.heading + 0.004 * wobble(t, 0.1));
  estimate.q_NB = Eigen::AngleAxisd(estimate.heading, Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(estimate.pitch, Vector3d::UnitY()) *
                  Eigen::AngleAxisd(estimate.roll, Vector3d::UnitX());
  estimate.sigma_p_N = Vector3d(0.03, 0.03, 0.05) + Vector3d::Constant(2.0 * std::exp(-t / 1.5));
  estimate.sigma_v_B = Vector3d::Constant(0.012);
  estimate.sigma_attitude = Vector3d(0.002, 0.002, 0.004);
}

ReportRun SyntheticFlight::fly(const std::filesystem::path& folder, const std::string& label,
                               bool with_truth) {
  using namespace std::chrono_literals;
  std::filesystem::create_directories(folder);
  for (const Vector3d& p : kWaypoints) {
    if (!waypoints_) break;
    autopilot::Waypoint waypoint;
    waypoint.p_N = p;
    signals_.route.waypoints.push_back(waypoint);
  }
  SignalTable table;
  table.add("truth", truth_);
  table.add("autopilot", signals_);
  Judge judge(checks(), table, {&truth_, &signals_}, 5ms);

  Recorder recorder(folder / "flight.mcap");
  if (with_truth) recorder.add("/truth/state", truth_);
  recorder.add("/autopilot/estimate", signals_.estimate);
  recorder.add("/autopilot/trajectory", signals_.trajectory, 20ms);
  recorder.add("/autopilot/flight", signals_.flight, 20ms);
  recorder.add("/autopilot/setpoint", signals_.setpoint, 10ms);
  recorder.add("/fcu/output_raw", outputs_, 20ms);
  recorder.add("/autopilot/route", signals_.route, 1s);
  recorder.metadata("run", {{"title", "Three waypoints, drawn by formulas"},
                            {"source", "synthetic"},
                            {"scenario", label},
                            {"seed", "7"},
                            {"vehicle", "models/x650"},
                            {"digest", "0f1e2d3c4b5a69788796a5b4c3d2e1f0"},
                            {"version", "0.1.0"},
                            {"config", "title = \"<three> & more\"\nseed = 7\n"}});
  constexpr int kTicks = 12000;
  for (int i = 0; i <= kTicks; ++i) {
    const std::chrono::nanoseconds now = i * 5ms;
    set(static_cast<double>(i) * 0.005);
    if (i == 6000) judge.event(now, "fault", "gust");
    if (i == 6500) judge.event(now, "fault_end", "gust");
    judge.observe(now);
    recorder.observe(now);
  }
  recorder.close();
  const RunIdentity identity{label, "Three waypoints, drawn by formulas", 7,
                             "0f1e2d3c4b5a69788796a5b4c3d2e1f0"};
  return {label, Log::read(folder / "flight.mcap"), judge.finish(identity, {}, 2.5)};
}

}  // namespace ironbird::scenarios
