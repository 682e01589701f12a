#pragma once

#include "autopilot/module/module.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Turns sensor frames into a state estimate, once per IMU sample.
class Estimator : public Module {
 public:
  /// One step. Refuses frames that are older than the last, and keeps the last finite estimate, marked lost,
  /// when the work function returns one that is not finite.
  /// @param frame  frames in stamp order
  /// @return the estimate at the frame's IMU stamp; valid until the next call
  const StateEstimate& run(const SensorFrame& frame);

  /// How often `run` was given a frame that was older than the one before, and refused it.
  int refused_frames() const { return refused_frames_; }

  /// How often the work function returned an estimate that was not finite.
  int non_finite_estimates() const { return non_finite_estimates_; }

  void reset() override;

 protected:
  /// The work. @param frame  all its samples are finite: `run` drops those that are not
  /// @param dt  time since the previous call, s, >= 0; 0 on the first
  virtual StateEstimate estimate(const SensorFrame& frame, double dt) = 0;

 private:
  StateEstimate last_;
  SensorFrame vetted_;
  Divider divider_;
  bool started_ = false;
  int refused_frames_ = 0;
  int non_finite_estimates_ = 0;
};

}  // namespace ironbird::autopilot
