#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/replay/recorded_flight.hpp"

namespace ironbird::scenarios {

/// Gives each position the velocity that the slope of its neighbours is: of the cubic that fits the positions
/// within half of `over` on either side best. A position whose neighbours do not reach that far on both
/// sides, or are fewer than five, gets none (`velocity_known` false).
/// @param positions  by time @param over  s, > 0
void add_slopes(std::vector<RecordedPosition>& positions, double over);

/// Moves positions of a place on the body to the body's origin, with the attitudes of the same truth. A
/// position of whose time the attitude is not known is taken out. @param p_BA_B  the place, m @return how
/// many were taken out
std::size_t move_to_body(RecordedEstimate& truth, const autopilot::Vector3& p_BA_B);

/// What a truth says between its samples: linear in position and velocity, on the shortest turn in attitude.
/// Across more than a second without a sample, and before the first and after the last, it says nothing.
class TruthTrack {
 public:
  /// @param truth  by time; outlives this
  explicit TruthTrack(const RecordedEstimate& truth) : truth_(truth) {}

  std::optional<autopilot::Vector3> position(hil_bridge::Time when) const;
  std::optional<autopilot::Vector3> velocity(hil_bridge::Time when) const;
  std::optional<autopilot::Quaternion> attitude(hil_bridge::Time when) const;

 private:
  const RecordedEstimate& truth_;
};

}  // namespace ironbird::scenarios
