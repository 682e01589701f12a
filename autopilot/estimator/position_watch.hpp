#pragma once

#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Counts the jumps of the horizontal position in a stream of estimates and says how far they went
/// all together, so that whoever holds a place in N can move it along by what was added. Whatever made the
/// jump: a reset, a large correction, an exchange of estimators.
class PositionWatch {
 public:
  /// From here on a change of position that the velocity does not explain is a jump, m.
  static constexpr double kLeastJump = 1.0;

  /// Goes on from the last estimate of a predecessor.
  void go_on_from(const StateEstimate& last) {
    last_ = last;
    resets_ = last.position_resets;
    sum_N_ = last.position_reset_sum_N;
  }

  /// Fills the members of the estimate that tell of jumps. @param fresh  later than the one before
  void observe(StateEstimate& fresh) {
    if (is_usable(fresh.health) && is_usable(last_.health)) {
      Vector3 jump_N = fresh.p_NB_N - last_.p_NB_N - last_.v_NB_N() * seconds(fresh.stamp - last_.stamp);
      jump_N.z() = 0.0;
      if (jump_N.squaredNorm() > kLeastJump * kLeastJump) {
        ++resets_;
        sum_N_ += jump_N;
      }
    }
    fresh.position_resets = resets_;
    fresh.position_reset_sum_N = sum_N_;
    last_ = fresh;
  }

 private:
  StateEstimate last_;
  std::uint32_t resets_ = 0;
  Vector3 sum_N_ = Vector3::Zero();
};

}  // namespace ironbird::autopilot
