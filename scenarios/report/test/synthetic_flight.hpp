#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "autopilot/signals.hpp"
#include "hil_bridge/rosflight/messages.hpp"
#include "scenarios/record/recorder.hpp"
#include "scenarios/report/report_run.hpp"
#include "scenarios/requirements/attitude.hpp"
#include "scenarios/requirements/judge.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

/// A flight drawn by formulas, recorded and judged like a real one: take-off, three waypoints, landing.
class SyntheticFlight {
 public:
  static constexpr double kEstimatorBegins = 1.0;  ///< s

  /// @param offset_east  what the estimate is wrong by, m
  explicit SyntheticFlight(double offset_east = 0.05) : offset_east_(offset_east) {}

  /// Leaves the route empty.
  void without_waypoints() { waypoints_ = false; }

  /// From 20 s to 25 s the operator keeps a height of 6 m by entry 1, and the trajectory waits.
  void with_an_operator() { operator_ = true; }

  /// Flies for 60 s at 200 Hz. @param with_truth  also record the truth
  ReportRun fly(const std::filesystem::path& folder, const std::string& label, bool with_truth = true);

 private:
  void set(double t);
  void set_estimate(double t, const EulerAngles& angles);

  double offset_east_;
  bool waypoints_ = true;
  bool operator_ = false;
  simulator::Truth truth_;
  autopilot::Signals signals_;
  hil_bridge::rosflight::RosflightOutputRaw outputs_;
};

}  // namespace ironbird::scenarios
