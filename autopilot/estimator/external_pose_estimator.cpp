#include "autopilot/estimator/external_pose_estimator.hpp"

#include <algorithm>

#include "autopilot/math/euler_zyx.hpp"
#include "autopilot/signals.hpp"

namespace ironbird::autopilot {

void ExternalPoseEstimator::reset() {
  Estimator::reset();
  pose_ = ExternalPose{};
  known_ = false;
  age_ = 0.0;
}

std::string ExternalPoseEstimator::objection(const Signals& signals) const {
  const Time heard = signals.external_pose_heard;
  if (heard.count() < 0) return "no pose from outside has ever arrived";
  const bool fresh = seconds(signals.sensors.imu.stamp - heard) <= params().lost;
  return fresh ? "" : "poses from outside no longer arrive";
}

StateEstimate ExternalPoseEstimator::estimate(const SensorFrame& frame, double /*dt*/) {
  StateEstimate x;
  x.stamp = frame.imu.stamp;
  x.w_NB_B = frame.imu.w_NB_B;
  if (frame.external_pose) {
    pose_ = *frame.external_pose;
    known_ = true;
  }
  if (!known_) return x;

  age_ = std::max(0.0, seconds(frame.imu.stamp - pose_.stamp));
  const double ahead = params().extrapolate ? std::min(age_, params().silence) : 0.0;
  const Vector3 turn_B = frame.imu.w_NB_B * ahead;  // rad
  const double angle = turn_B.norm();
  x.q_NB = pose_.q_NB.normalized();
  if (angle > 0.0) x.q_NB = x.q_NB * Quaternion(Eigen::AngleAxisd(angle, turn_B / angle));
  x.p_NB_N = pose_.p_NB_N + pose_.v_NB_N * ahead;
  x.v_NB_B = x.q_NB.conjugate() * pose_.v_NB_N;
  const Vector3 theta = euler_from_quaternion(x.q_NB);
  x.roll = theta.x();
  x.pitch = theta.y();
  x.heading = theta.z();
  x.position_age = age_;
  x.health = age_ > params().silence ? Health::kDegraded : Health::kGood;
  if (age_ > params().lost) x.health = Health::kLost;
  return x;
}

void ExternalPoseEstimator::probe(ProbeVisitor& visit) const {
  visit("pose_age", age_, "s");
}

}  // namespace ironbird::autopilot
