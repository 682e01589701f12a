#include "simulator/plant/rigid_body_plant.hpp"

#include <cmath>

namespace ironbird::simulator {
namespace {

using QuaternionCoefficients = Eigen::Matrix<double, 4, 1>;  // of a quaternion, in Eigen's order x, y, z, w

/// Time derivative of everything that the plant integrates.
struct Rates {
  Vector3 p_N;
  QuaternionCoefficients q;
  Vector3 v_N;
  Vector3 w_B;
  RotorSpeeds rotors;

  void add(double weight, const Rates& other) {
    p_N += weight * other.p_N;
    q += weight * other.q;
    v_N += weight * other.v_N;
    w_B += weight * other.w_B;
    rotors += weight * other.rotors;
  }
};

/// `state` and `rotors` after `dt` at constant rates, with the quaternion back on the unit sphere.
void move(const Rates& rates, double dt, RigidBodyState& state, RotorSpeeds& rotors) {
  state.p_NB_N += dt * rates.p_N;
  state.q_NB.coeffs() += dt * rates.q;
  state.q_NB.normalize();
  state.v_NB_N += dt * rates.v_N;
  state.w_NB_B += dt * rates.w_B;
  rotors += dt * rates.rotors;
}

}  // namespace

void RigidBodyPlant::configure(const MassProperties& mass, double gravity) {
  mass_ = mass;
  J_inverse_ = mass.J_Bcm_B.inverse();
  gravity_ = gravity;
}

void RigidBodyPlant::reset(const RigidBodyState& state, const RotorSpeeds& rotors) {
  state_ = state;
  state_.q_NB.normalize();
  rotors_ = rotors;
}

void RigidBodyPlant::step(double dt, ForceModel& forces) {
  const auto rates_at = [&](const RigidBodyState& state, const RotorSpeeds& rotors, double offset) {
    const Forces acting = forces.evaluate(state, rotors, offset);
    const Vector3& w_B = state.w_NB_B;
    const Vector3 L_B = mass_.J_Bcm_B * w_B;
    const Quaternion turn(0.0, w_B.x(), w_B.y(), w_B.z());
    Rates rates;
    rates.p_N = state.v_NB_N;
    rates.q = 0.5 * (state.q_NB * turn).coeffs();
    rates.v_N = state.q_NB * acting.wrench.F_Bcm_B / mass_.mass;
    rates.v_N.z() += gravity_;
    rates.w_B = J_inverse_ * (acting.wrench.M_Bcm_B - w_B.cross(L_B));
    rates.rotors = acting.rotor_acceleration;
    return rates;
  };
  const auto rates_after = [&](const Rates& rates, double offset) {
    RigidBodyState state = state_;
    RotorSpeeds rotors = rotors_;
    move(rates, offset, state, rotors);
    return rates_at(state, rotors, offset);
  };

  const Rates k1 = rates_at(state_, rotors_, 0.0);
  const Rates k2 = rates_after(k1, 0.5 * dt);
  const Rates k3 = rates_after(k2, 0.5 * dt);
  const Rates k4 = rates_after(k3, dt);
  Rates sum = k1;
  sum.add(2.0, k2);
  sum.add(2.0, k3);
  sum.add(1.0, k4);
  move(sum, dt / 6.0, state_, rotors_);
  forces.settle(state_, rotors_);
}

const char* RigidBodyPlant::failure() const {
  const bool finite = state_.p_NB_N.allFinite() && state_.q_NB.coeffs().allFinite() &&
                      state_.v_NB_N.allFinite() && state_.w_NB_B.allFinite() && rotors_.allFinite();
  return finite ? nullptr : "the state is not finite";
}

}  // namespace ironbird::simulator
