#pragma once

#include <variant>

#include "autopilot/types/fcu_command.hpp"
#include "autopilot/types/sensor_frame.hpp"

namespace ironbird::autopilot {

/// A rigid body with lagging rotors over flat ground, for closing the loop around an autopilot: 3.9 kg, the
/// inertia of an X650, 35 ms of lag, 2.5 ms between frames, an FCU that obeys torque and thrust, and a
/// perfect external pose. It has no wind, no drag and no noise.
class LittleVehicle {
 public:
  static constexpr double kMass = 3.9;      // kg
  static constexpr double kLag = 0.035;     // s
  static constexpr double kGravity = 9.81;  // m/s^2
  static constexpr int kSubsteps = 5;
  static constexpr double kStep = 0.0025 / kSubsteps;  // s

  /// Flies `command` for one frame. Silence, and anything but torque and thrust, means no thrust.
  void fly(const FcuCommand& command) {
    const auto* wanted = std::get_if<PassThroughCommand>(&command);
    for (int i = 0; i < kSubsteps; ++i) {
      const double share = kStep / kLag;
      thrust_ += share * ((wanted != nullptr && status.armed ? wanted->thrust : 0.0) - thrust_);
      M_B_ += share * ((wanted != nullptr && status.armed ? wanted->M_B : Vector3(0, 0, 0)) - M_B_);
      substep();
    }
    now_ += std::chrono::microseconds(2500);
  }

  SensorFrame frame() const {
    SensorFrame frame;
    frame.imu.stamp = now_;
    frame.imu.w_NB_B = w_NB_B;
    frame.imu.f_B = q_NB.conjugate() * (a_NB_N_ - Vector3(0, 0, kGravity));
    frame.external_pose = ExternalPose{now_, p_NB_N, q_NB, v_NB_N};
    frame.status = status;
    return frame;
  }

  Vector3 p_NB_N = Vector3::Zero();
  Vector3 v_NB_N = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Vector3 w_NB_B = Vector3::Zero();
  FcuStatus status;

 private:
  void substep() {
    const Vector3 J_B(0.08, 0.08, 0.14);  // kg m^2
    a_NB_N_ = q_NB * Vector3(0, 0, -thrust_ / kMass) + Vector3(0, 0, kGravity);
    const Vector3 spin_B = J_B.cwiseProduct(w_NB_B);
    w_NB_B += kStep * (M_B_ - w_NB_B.cross(spin_B)).cwiseQuotient(J_B);
    v_NB_N += kStep * a_NB_N_;
    if (p_NB_N.z() >= 0.0 && v_NB_N.z() >= 0.0) {  // on the ground nothing moves
      v_NB_N.setZero();
      w_NB_B.setZero();
      a_NB_N_.setZero();
    }
    p_NB_N += kStep * v_NB_N;
    const double angle = w_NB_B.norm() * kStep;
    if (angle > 0.0) q_NB = (q_NB * Quaternion(Eigen::AngleAxisd(angle, w_NB_B.normalized()))).normalized();
  }

  Time now_{0};
  double thrust_ = 0.0;
  Vector3 M_B_ = Vector3::Zero();
  Vector3 a_NB_N_ = Vector3::Zero();
};

}  // namespace ironbird::autopilot
