#include "simulator/plant/ode_plant.hpp"

#include <cmath>
#include <stdexcept>

#include "simulator/plant/ode_body.hpp"
#include "simulator/plant/proximity.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kContactStep = 0.5e-3;  // s
constexpr double kRestStep = 2.5e-3;     // s
constexpr double kFlightStep = 2.5e-3;   // s

/// The rotation by a rotation vector, rad.
Quaternion turn(const Vector3& angle) {
  const double norm = angle.norm();
  constexpr double kSeriesBelow = 1e-4;  // where the next term is below rounding
  const double factor = norm < kSeriesBelow ? 0.5 - norm * norm / 48.0 : std::sin(0.5 * norm) / norm;
  return {std::cos(0.5 * norm), factor * angle.x(), factor * angle.y(), factor * angle.z()};
}

class OdePlant final : public Plant {
 public:
  OdePlant(const VehicleParams& vehicle, const FieldParams& field)
      : body_(vehicle.contact, field), proximity_(vehicle.contact, field) {
    configure({vehicle.mass, vehicle.inertia.matrix()}, 9.80665);
    reset(RigidBodyState{}, RotorSpeeds::Zero());
  }

  void configure(const MassProperties& mass, double gravity) override {
    mass_ = mass;
    J_inverse_ = mass.J_Bcm_B.inverse();
    gravity_ = gravity;
    body_.configure(mass, gravity);
  }

  void reset(const RigidBodyState& state, const RotorSpeeds& rotors) override {
    state_ = state;
    state_.q_NB.normalize();
    rotors_ = rotors;
    failure_ = nullptr;
    in_contact_ = false;
    proximity_.update(state_.p_NB_N, state_.v_NB_N.norm());
    body_.write(state_);
  }

  void step(double dt, ForceModel& forces) override {
    try {
      const bool near = proximity_.update(state_.p_NB_N, state_.v_NB_N.norm());
      in_contact_ = near && body_.find_contacts(dt) > 0;
      const Wrench wrench = wrench_at_mid_step(dt, forces);
      if (in_contact_) {
        step_in_contact(dt, wrench);
      } else {
        step_in_air(dt, wrench);
      }
    } catch (const std::runtime_error&) {
      failure_ = "ODE reported an error";
    }
    forces.settle(state_, rotors_);
    if (!state_.p_NB_N.allFinite() || !state_.q_NB.coeffs().allFinite()) failure_ = "the state is not finite";
  }

  const RigidBodyState& state() const override { return state_; }
  const RotorSpeeds& rotors() const override { return rotors_; }
  bool in_contact() const override { return in_contact_; }
  const char* failure() const override { return failure_; }
  double contact_step() const override {
    if (!proximity_.near()) return kFlightStep;
    return in_contact_ && nearly_at_rest(state_) ? kRestStep : kContactStep;
  }

 private:
  Vector3 angular_acceleration(const Vector3& M_B, const Vector3& w_B) const {
    const Vector3 L_B = mass_.J_Bcm_B * w_B;
    return J_inverse_ * (M_B - w_B.cross(L_B));
  }

  /// Asks the forces twice, as the midpoint rule does, and moves the rotor speeds on with them.
  Wrench wrench_at_mid_step(double dt, ForceModel& forces) {
    const double half = 0.5 * dt;
    const Forces start = forces.evaluate(state_, rotors_, 0.0);
    Vector3 a_N = state_.q_NB * start.wrench.F_Bcm_B / mass_.mass;
    a_N.z() += gravity_;
    RigidBodyState mid = state_;
    mid.p_NB_N += half * state_.v_NB_N;
    mid.v_NB_N += half * a_N;
    mid.q_NB = state_.q_NB * turn(half * state_.w_NB_B);
    mid.w_NB_B += half * angular_acceleration(start.wrench.M_Bcm_B, state_.w_NB_B);
    const RotorSpeeds mid_rotors = rotors_ + half * start.rotor_acceleration;
    const Forces acting = forces.evaluate(mid, mid_rotors, half);
    rotors_ += dt * acting.rotor_acceleration;
    return acting.wrench;
  }

  /// The engine's own step, first order.
  void step_in_contact(double dt, const Wrench& wrench) {
    const Matrix3 R_NB = state_.q_NB.toRotationMatrix();
    body_.step(dt, R_NB * wrench.F_Bcm_B, R_NB * wrench.M_Bcm_B, true);
    body_.forget_contacts();
    state_ = body_.read();
  }

  /// Second order. The engine turns with the new velocity where the mean is meant: a lead of half a step,
  /// taken back afterwards. It gets the torque that leads to the angular momentum which the midpoint rule
  /// wants.
  void step_in_air(double dt, const Wrench& wrench) {
    const RigidBodyState before = state_;
    const Vector3& w = before.w_NB_B;
    const Vector3 w_mid = w + 0.5 * dt * angular_acceleration(wrench.M_Bcm_B, w);
    const Vector3 w_next = w + dt * angular_acceleration(wrench.M_Bcm_B, w_mid);
    const Quaternion q_mid = before.q_NB * turn(0.5 * dt * w_mid);
    const Quaternion q_next = before.q_NB * turn(dt * w_mid);
    const Matrix3 R_NB = before.q_NB.toRotationMatrix();
    const Vector3 w_N = R_NB * w;
    const Vector3 w_next_N = q_next * w_next;
    const Vector3 M_N = R_NB * (mass_.J_Bcm_B * (R_NB.transpose() * (w_next_N - w_N))) / dt;
    body_.step(dt, q_mid * wrench.F_Bcm_B, M_N, false);

    state_ = body_.read();
    const Vector3 reached_w_N = state_.q_NB * state_.w_NB_B;
    state_.p_NB_N -= 0.5 * dt * (state_.v_NB_N - before.v_NB_N);
    state_.q_NB = (turn(-0.5 * dt * (reached_w_N - w_N)) * state_.q_NB).normalized();
    state_.w_NB_B = state_.q_NB.conjugate() * reached_w_N;
    body_.write(state_);
  }

  OdeBody body_;
  Proximity proximity_;
  MassProperties mass_;
  Matrix3 J_inverse_ = Matrix3::Identity();
  double gravity_ = 9.80665;
  RigidBodyState state_;
  RotorSpeeds rotors_ = RotorSpeeds::Zero();
  bool in_contact_ = false;
  const char* failure_ = nullptr;
};

}  // namespace

std::unique_ptr<Plant> make_ode_plant(const VehicleParams& vehicle, const FieldParams& field) {
  return std::make_unique<OdePlant>(vehicle, field);
}

}  // namespace ironbird::simulator
