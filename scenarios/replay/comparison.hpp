#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "autopilot/types/state_estimate.hpp"
#include "scenarios/replay/recorded_flight.hpp"
#include "scenarios/requirements/metrics.hpp"

namespace ironbird::scenarios {

/// Ours less the recorded one, at one time. What is not known of either is not a number.
struct EstimateDifference {
  hil_bridge::Time stamp{};
  autopilot::Vector3 p_N = autopilot::Vector3::Zero();
  autopilot::Vector3 v_N = autopilot::Vector3::Zero();
  autopilot::Vector3 theta = autopilot::Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the recorded estimate was valid");
    visit("p_N", self.p_N, "m", "of the position, north, east, down; down with the constant between the two");
    visit("v_N", self.v_N, "m/s", "of the velocity over ground");
    visit("theta", self.theta, "rad", "of roll, pitch, heading");
  }
};

/// Where `p_N` is seen from another origin. @return `p_N` itself while one of them is not known
autopilot::Vector3 seen_from(const autopilot::LocalOrigin& other, const autopilot::Vector3& p_N,
                             const autopilot::LocalOrigin& origin);

/// Holds an estimate against a recorded one while it is made: at the recorded one's own times, ours linear in
/// between.
///
/// Positions are compared on the earth, where both say where their origin lies; where the recorded one does
/// not, from the place at which it began. Both count heights from what their barometer said at some time, so
/// the mean of the difference down is taken off.
class Comparison {
 public:
  /// @param recorded  outlives this
  /// @param window    what counts
  Comparison(const RecordedEstimate& recorded, Interval window);

  /// To be called with each estimate, in order of time. @return the differences that it completes
  const std::vector<EstimateDifference>& observe(const autopilot::StateEstimate& ours);

  /// Root mean squares over the window, and how much of it could be compared.
  std::vector<Metric> results() const;

 private:
  /// Sums of one number.
  struct Sum {
    std::size_t count = 0;
    double sum = 0.0;
    double squares = 0.0;
    void add(double value);
    double rms() const;
    double deviation() const;
  };

  void compare(const RecordedAttitude& recorded, double share, const autopilot::StateEstimate& ours);
  void compare(const RecordedPosition& recorded, double share, const autopilot::StateEstimate& ours);
  bool counts(hil_bridge::Time when) const { return when >= window_.begin && when <= window_.end; }

  const RecordedEstimate& recorded_;
  Interval window_;
  std::optional<autopilot::StateEstimate> before_;
  std::size_t next_attitude_ = 0;
  std::size_t next_position_ = 0;
  // Recorded values in the window that were believed.
  std::size_t wanted_attitudes_ = 0;
  std::size_t wanted_positions_ = 0;
  std::size_t wanted_heights_ = 0;
  std::size_t wanted_velocities_ = 0;
  Sum north_;
  Sum east_;
  Sum horizontal_;
  Sum down_;
  Sum velocity_;
  Sum roll_;
  Sum pitch_;
  Sum heading_;
  std::vector<EstimateDifference> differences_;
};

}  // namespace ironbird::scenarios
