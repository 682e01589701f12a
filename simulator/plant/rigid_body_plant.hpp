#pragma once

#include "simulator/plant/plant.hpp"

namespace ironbird::simulator {

/// Classical fourth-order Runge-Kutta for one free rigid body. No ground: the oracle of the other plants, and
/// the fast lane of sweeps that stay in the air.
class RigidBodyPlant final : public Plant {
 public:
  void configure(const MassProperties& mass, double gravity) override;
  void reset(const RigidBodyState& state, const RotorSpeeds& rotors) override;
  void step(double dt, ForceModel& forces) override;
  const RigidBodyState& state() const override { return state_; }
  const RotorSpeeds& rotors() const override { return rotors_; }
  bool in_contact() const override { return false; }
  const char* failure() const override;
  double contact_step() const override { return 5e-3; }

 private:
  MassProperties mass_;
  Matrix3 J_inverse_ = Matrix3::Identity();
  double gravity_ = 9.80665;
  RigidBodyState state_;
  RotorSpeeds rotors_ = RotorSpeeds::Zero();
};

}  // namespace ironbird::simulator
