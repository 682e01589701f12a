#pragma once

#include "autopilot/estimator/estimator.hpp"
#include "autopilot/module/tunable.hpp"

namespace ironbird::autopilot {

/// Parameters of ExternalPoseEstimator.
struct ExternalPoseParams {
  double silence = 0.2;
  double lost = 1.0;
  bool extrapolate = true;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("silence", self.silence, "s", "without a pose for this long: degraded", 0.0, 60.0);
    visit("lost", self.lost, "s", "without a pose for this long: lost", 0.05, 60.0);
    visit("extrapolate", self.extrapolate, "1", "carry the pose to the IMU stamp with velocity and gyro");
  }
};

/// Passes a pose from outside (motion capture, or truth) through, with the rates of the gyro. Estimates no
/// bias. Without poses it has neither place nor attitude, and says so.
class ExternalPoseEstimator final : public Tunable<Estimator, ExternalPoseParams> {
 public:
  void reset() override;
  void probe(ProbeVisitor& visit) const override;
  bool needs_external_pose() const override { return true; }
  /// Poses must be arriving.
  std::string objection(const Signals& signals) const override;

 protected:
  StateEstimate estimate(const SensorFrame& frame, double dt) override;

 private:
  ExternalPose pose_;
  bool known_ = false;
  double age_ = 0.0;  // s
};

}  // namespace ironbird::autopilot
