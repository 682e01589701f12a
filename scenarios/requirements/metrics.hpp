#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "autopilot/signals.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

/// One figure of a run.
struct Metric {
  std::string name;
  double value = 0.0;  ///< NaN when nothing was there to measure
  std::string unit;
  std::string meaning;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "stable name");
    visit("value", self.value, "SI", "in `unit`; not a number when nothing was there to measure");
    visit("unit", self.unit, "", "unit of the value");
    visit("meaning", self.meaning, "", "what was measured, and when");
  }
};

/// The only figures that are there without a flight.
inline constexpr const char* kFlightTime = "flight_s";
inline constexpr const char* kSimulatedTime = "simulated_s";

/// Mean square of a number seen sample by sample.
class MeanSquare {
 public:
  void add(double value) {
    sum_ += value * value;
    ++count_;
  }
  /// Root of the mean square; NaN without a sample.
  double root() const;
  bool empty() const { return count_ == 0; }

 private:
  double sum_ = 0.0;
  std::int64_t count_ = 0;
};

/// The figures of one run, kept while it runs.
///
/// Path error: distance of a position to the nearest point of the polyline through the waypoints, from the
/// time the first waypoint is reached until the last is; ROScopter paper, results. A cyclic route has no last
/// waypoint: the polyline is closed and counts until the end. Tracking error: distance to where the
/// trajectory is at the same time, while the companion flies. Estimation error: while armed and off the
/// ground; needs the truth; of several axes the worst one counts, except where a name says `total` or
/// `position`. The polyline is that of the route in force, the way home included. All are sampled at one
/// fixed rate, so that the ticks of a run do not weigh on its figures.
class RunMetrics {
 public:
  using Time = std::chrono::nanoseconds;

  /// What is watched; both must outlive the metrics.
  struct Sources {
    const simulator::Truth* truth = nullptr;        ///< null on hardware
    const autopilot::Signals* autopilot = nullptr;  ///< never null
  };

  /// @param period  time between samples, > 0
  explicit RunMetrics(Sources sources, Time period = std::chrono::milliseconds(20));

  /// To be called after every tick, in order of time.
  void observe(Time now) {
    last_ = now;
    if (now >= next_) sample(now);
  }

  /// Wall-clock time that the run took, s, > 0; without it there is no real-time factor.
  void set_wall_time(double wall_seconds) { wall_seconds_ = wall_seconds; }

  /// Every metric there is, always the same names in the same order.
  std::vector<Metric> results() const;

  /// The metrics that there are, without values.
  static std::vector<Metric> names_and_units();

 private:
  using Axes = std::array<MeanSquare, 3>;

  void sample(Time now);
  void sample_path();
  void sample_estimate();
  void append_estimate(std::vector<Metric>& out) const;

  Sources sources_;
  Time period_;
  Time next_{0};
  Time last_{0};
  Time airborne_{0};
  double wall_seconds_ = 0.0;
  double max_tilt_ = 0.0;
  double max_speed_ = 0.0;
  Axes path_;
  Axes true_path_;
  Axes tracking_;
  Axes true_tracking_;
  Axes position_;
  Axes velocity_;
  Axes angles_;
  MeanSquare attitude_;
};

/// Whether a moment counts for the path error: the companion flies, a waypoint is behind it and another
/// before.
bool counts_for_path(const autopilot::FlightStatus& flight, const autopilot::TrajectoryPoint& trajectory,
                     const autopilot::Route& route);

/// From `p_N` to the nearest point of the polyline through the waypoints of `route`, m; the zero vector when
/// the route is empty. A cyclic route is closed.
Eigen::Vector3d to_polyline(const Eigen::Vector3d& p_N, const autopilot::Route& route);

}  // namespace ironbird::scenarios
