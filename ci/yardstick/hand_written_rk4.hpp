#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace ironbird::yardstick {

/// What a quadrotor costs that somebody writes down for itself: pose, velocities and four lagged rotors in
/// one array of seventeen numbers, linear drag, the classical fourth-order scheme. No library, no parameters,
/// no use but to be timed.
class HandWrittenRk4 {
 public:
  using State = std::array<double, 17>;  // p_N, v_N, q (w, x, y, z), w_B, rotor speeds

  /// @param dt  s
  void step(double dt) {
    throttle_ = -throttle_;  // so that it never comes to rest
    const State k1 = rates(x_);
    const State k2 = rates(moved(k1, 0.5 * dt));
    const State k3 = rates(moved(k2, 0.5 * dt));
    const State k4 = rates(moved(k3, dt));
    for (std::size_t i = 0; i < x_.size(); ++i)
      x_[i] += dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    const double norm = std::sqrt(x_[6] * x_[6] + x_[7] * x_[7] + x_[8] * x_[8] + x_[9] * x_[9]);
    for (std::size_t i = 6; i < 10; ++i) x_[i] /= norm;
  }

  const State& state() const { return x_; }

 private:
  static constexpr double kHover = 500.0;   // rad/s
  static constexpr double kMass = 3.5;      // kg
  static constexpr double kGravity = 9.81;  // m/s^2
  static constexpr double kThrust = kMass * kGravity / (4.0 * kHover * kHover);
  static constexpr double kTorque = 0.02 * kThrust;
  static constexpr double kArm = 0.2;   // m
  static constexpr double kLag = 0.03;  // s
  static constexpr double kDrag = 0.3;  // N per m/s
  static constexpr std::array<double, 3> kInertia = {0.08, 0.08, 0.12};

  State moved(const State& k, double dt) const {
    State moved;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = x_[i] + dt * k[i];
    return moved;
  }

  State rates(const State& x) const {
    const double w = x[6], i = x[7], j = x[8], k = x[9];
    const double p = x[10], q = x[11], r = x[12];
    std::array<double, 4> lift{};
    for (std::size_t n = 0; n < 4; ++n) lift[n] = kThrust * x[13 + n] * x[13 + n];
    const double total = lift[0] + lift[1] + lift[2] + lift[3];
    State rate;
    for (std::size_t n = 0; n < 3; ++n) rate[n] = x[3 + n];
    rate[3] = (-total * 2.0 * (i * k + w * j) - kDrag * x[3]) / kMass;
    rate[4] = (-total * 2.0 * (j * k - w * i) - kDrag * x[4]) / kMass;
    rate[5] = (-total * (1.0 - 2.0 * (i * i + j * j)) - kDrag * x[5]) / kMass + kGravity;
    rate[6] = 0.5 * (-i * p - j * q - k * r);
    rate[7] = 0.5 * (w * p + j * r - k * q);
    rate[8] = 0.5 * (w * q - i * r + k * p);
    rate[9] = 0.5 * (w * r + i * q - j * p);
    const double roll = kArm * (-lift[0] - lift[1] + lift[2] + lift[3]);
    const double pitch = kArm * (lift[0] - lift[1] - lift[2] + lift[3]);
    const double yaw = kTorque / kThrust * (lift[0] - lift[1] + lift[2] - lift[3]);
    rate[10] = (roll - (kInertia[2] - kInertia[1]) * q * r) / kInertia[0];
    rate[11] = (pitch - (kInertia[0] - kInertia[2]) * p * r) / kInertia[1];
    rate[12] = (yaw - (kInertia[1] - kInertia[0]) * p * q) / kInertia[2];
    for (std::size_t n = 0; n < 4; ++n)
      rate[13 + n] = (kHover + (n == 0 ? throttle_ : 0.0) - x[13 + n]) / kLag;
    return rate;
  }

  State x_ = {0, 0, -50, 1, 2, -3, 1, 0, 0, 0, 0.1, 0.2, 0.3, kHover, kHover, kHover, kHover};
  double throttle_ = 1.0;
};

}  // namespace ironbird::yardstick
