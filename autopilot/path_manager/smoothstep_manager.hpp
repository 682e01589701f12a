#pragma once

#include "autopilot/module/tunable.hpp"
#include "autopilot/path_manager/sequenced_manager.hpp"

namespace ironbird::autopilot {

/// Constants of the smooth-step manager. The limits lie beside the other parameters, not below a name of
/// their own.
struct SmoothstepManagerParams : MotionLimits {
  double waypoint_tolerance = 0.5;
  bool switch_early = false;
  bool reference_first_leg = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    MotionLimits::describe(self, visit);
    visit("waypoint_tolerance", self.waypoint_tolerance, "m", "distance at which a waypoint is reached", 0.01,
          100.0);
    visit("switch_early", self.switch_early, "1",
          "a waypoint is reached as soon as it is within tolerance, wherever the reference is");
    visit("reference_first_leg", self.reference_first_leg, "1",
          "the first leg comes from the origin, heading north, and the clock runs whoever flies");
  }
};

/// Straight legs, rest to rest, blended by the quintic smooth step: position and heading along the shortest
/// arc share one blend and one duration. ROScopter paper, path manager. It does not round corners.
class SmoothstepManager final : public Tunable<SequencedManager, SmoothstepManagerParams> {
 public:
  SmoothstepManager() { on_parameters(); }

 protected:
  void on_parameters() override;
  std::uint32_t depart(const Departure& departure, const Route& route, std::uint32_t first) override;
  MotionPoint evaluate(double elapsed) const override;

 private:
  Vector3 start_N_ = Vector3::Zero();
  Vector3 way_N_ = Vector3::Zero();
  double start_heading_ = 0.0;
  double turn_ = 0.0;
  double duration_ = 0.0;
};

}  // namespace ironbird::autopilot
