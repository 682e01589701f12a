#pragma once

#include "simulator/plant/field.hpp"
#include "simulator/types/rigid_body_state.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

/// Moves so slowly that contact, which has a memory of some 20 ms, is well served by steps of 2.5 ms.
bool nearly_at_rest(const RigidBodyState& state);

/// Tells an engine when contact can be left out because nothing is within reach.
///
/// The vehicle counts as the smallest sphere about its centre of mass that holds everything that can touch,
/// so attitude does not matter. Contact comes on well before anything can be reached, with hysteresis. The
/// ground has no underside: below it counts as near.
class Proximity {
 public:
  Proximity(const ContactParams& vehicle, const FieldParams& field);

  /// Takes the position and speed into account. @return something may be touched soon
  bool update(const Vector3& p_NB_N, double speed);

  /// Result of the last `update`.
  bool near() const { return near_; }

  /// Distance from the sphere to the nearest thing, m; negative when it reaches in, infinite in an empty
  /// field.
  double clearance(const Vector3& p_NB_N) const;

 private:
  FieldParams field_;
  double reach_ = 0.0;
  bool near_ = true;
};

}  // namespace ironbird::simulator
