#pragma once

#include <cmath>

#include "simulator/plant/plant.hpp"

namespace ironbird::simulator {

constexpr double kGravity = 9.80665;  // m/s^2

/// The same wrench in body axes all the time; with none, a free body.
struct HeldWrench : ForceModel {
  Wrench wrench;
  Forces evaluate(const RigidBodyState&, const RotorSpeeds&, double) override { return {wrench}; }
};

/// A force that is constant in N.
struct HeldForceInN : ForceModel {
  Vector3 F_N = Vector3::Zero();
  Forces evaluate(const RigidBodyState& state, const RotorSpeeds&, double) override {
    Forces forces;
    forces.wrench.F_Bcm_B = state.q_NB.conjugate() * F_N;
    return forces;
  }
};

/// Drag k v^2 against the velocity.
struct QuadraticDrag : ForceModel {
  double k = 0.0;  // N s^2/m^2
  Forces evaluate(const RigidBodyState& state, const RotorSpeeds&, double) override {
    Forces forces;
    const Vector3 drag_N = -k * state.v_NB_N.norm() * state.v_NB_N;
    forces.wrench.F_Bcm_B = state.q_NB.conjugate() * drag_N;
    return forces;
  }
};

/// Four lagged rotors that a feedback, evaluated in every stage, flies round a figure of eight in space.
/// Smooth, so that the order of a scheme can be seen.
class FigureOfEight : public ForceModel {
 public:
  /// @param down  where its middle is, m
  FigureOfEight(double mass, const Matrix3& J_B, double down = -50.0) : mass_(mass), J_B_(J_B), down_(down) {}

  /// Of the step that comes next, s.
  void set_start(double start) { start_ = start; }

  Forces evaluate(const RigidBodyState& state, const RotorSpeeds& rotors, double offset) override {
    const RotorSpeeds wanted = wanted_speeds(state, start_ + offset);
    const Eigen::Array4d thrust = kThrust * rotors.head<4>().square();
    Forces forces;
    forces.wrench.F_Bcm_B = Vector3(0.0, 0.0, -thrust.sum()) - 0.3 * (state.q_NB.conjugate() * state.v_NB_N);
    forces.wrench.M_Bcm_B = moments(thrust);
    forces.rotor_acceleration = (wanted - rotors) / kLag;
    return forces;
  }

  RigidBodyState start() const {
    RigidBodyState state;
    state.p_NB_N = {0.0, 0.0, down_};
    return state;
  }

  RotorSpeeds hover() const {
    RotorSpeeds speeds = RotorSpeeds::Zero();
    speeds.head<4>().setConstant(std::sqrt(mass_ * kGravity / 4.0 / kThrust));
    return speeds;
  }

 private:
  static constexpr double kThrust = 5.7e-5;  // N s^2/rad^2
  static constexpr double kTorque = 0.0187;  // m, torque per thrust
  static constexpr double kArm = 0.177;      // m
  static constexpr double kLag = 0.035;      // s

  static Vector3 moments(const Eigen::Array4d& T) {
    return {kArm * (-T[0] - T[1] + T[2] + T[3]), kArm * (T[0] - T[1] - T[2] + T[3]),
            kTorque * (T[0] - T[1] + T[2] - T[3])};
  }

  RotorSpeeds wanted_speeds(const RigidBodyState& state, double t) const {
    const Vector3 p(3.0 * std::sin(0.9 * t), 2.0 * std::sin(1.8 * t), down_ + std::sin(0.5 * t));
    const Vector3 v(2.7 * std::cos(0.9 * t), 3.6 * std::cos(1.8 * t), 0.5 * std::cos(0.5 * t));
    const Vector3 a_N = 1.5 * (p - state.p_NB_N) + 2.0 * (v - state.v_NB_N) - Vector3(0.0, 0.0, kGravity);
    const Vector3 up_B = state.q_NB.conjugate() * a_N.normalized();
    const Vector3 lean = Vector3(0.0, 0.0, -1.0).cross(up_B);
    const Vector3 M = J_B_ * (60.0 * lean - 14.0 * state.w_NB_B);
    const double thrust = mass_ * a_N.norm() / 4.0;
    const double roll = M.x() / (4.0 * kArm);
    const double pitch = M.y() / (4.0 * kArm);
    const double yaw = M.z() / (4.0 * kTorque);
    const Eigen::Array4d T(thrust - roll + pitch + yaw, thrust - roll - pitch - yaw,
                           thrust + roll - pitch + yaw, thrust + roll + pitch - yaw);
    RotorSpeeds speeds = RotorSpeeds::Zero();
    speeds.head<4>() = (T.max(0.1) / kThrust).sqrt();
    return speeds;
  }

  double mass_;
  Matrix3 J_B_;
  double down_;
  double start_ = 0.0;
};

}  // namespace ironbird::simulator
