#pragma once

#include <optional>

#include "autopilot/estimator/frame_clock.hpp"
#include "autopilot/estimator/position_watch.hpp"
#include "autopilot/module/module.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Turns sensor frames into a state estimate, once per IMU sample.
class Estimator : public Module {
 public:
  /// One step. Refuses frames whose stamps do not go on from the last (FrameClock); after too many in a row
  /// the estimate is lost. Drops samples that are not finite or physically absurd, and a fix that was there
  /// before: a slower sensor is then silent. In place of the IMU stand its specific force of late and a rate
  /// that dies away as the loops make it; the estimate is marked degraded, and lost after 0.2 s. Keeps the
  /// last finite estimate, marked lost, when the work function returns one that is not finite. Counts jumps
  /// of the position. With a period, the IMU samples between two works are averaged, and the newest sample of
  /// each slower sensor waits for the next work.
  /// @param frame  frames in stamp order
  /// @return the estimate at the stamp of the last work; valid until the next call
  const StateEstimate& run(const SensorFrame& frame);

  /// It flies on poses from outside only; where none can arrive it is of no use.
  virtual bool needs_external_pose() const { return false; }

  /// How often `run` was given a frame whose stamp did not go on from the ones before, and refused it.
  int refused_frames() const { return refused_frames_; }

  /// How many samples were dropped because they were not finite, absurd, or given before.
  int dropped_samples() const { return dropped_samples_; }

  /// How often the work function returned an estimate that was not finite.
  int non_finite_estimates() const { return non_finite_estimates_; }

  void reset() override;

  /// A jump from the estimate of the predecessor is counted as any other.
  void take_over(const Handover& left) override;

 protected:
  /// The work. @param frame  all its samples are finite: `run` drops those that are not
  /// @param dt  time since the previous call, s, >= 0; 0 on the first
  virtual StateEstimate estimate(const SensorFrame& frame, double dt) = 0;

  /// Before this work the IMU was away for longer than FrameClock::kLongestGap: missing or not sound.
  bool imu_was_away() const { return imu_was_away_; }

 private:
  void collect(SensorFrame frame, Time now);
  int keep_new_fix(const std::optional<GnssSample>& newer);
  void merge_imu(double dt);
  void lose();
  void forget_samples();

  StateEstimate last_;
  SensorFrame vetted_;
  Vector3 f_sum_B_ = Vector3::Zero();
  Vector3 w_sum_B_ = Vector3::Zero();
  int imu_count_ = 0;
  Vector3 f_calm_B_ = Vector3::Zero();  // of the sound samples, low-passed
  Vector3 w_calm_B_ = Vector3::Zero();
  bool imu_known_ = false;
  bool imu_held_ = false;
  bool imu_was_away_ = false;
  Time imu_heard_{0};
  std::optional<Time> newest_fix_;
  Divider divider_;
  FrameClock clock_;
  PositionWatch watch_;
  int refused_frames_ = 0;
  int dropped_samples_ = 0;
  int non_finite_estimates_ = 0;
};

}  // namespace ironbird::autopilot
