// What the interface promises, whatever the scheme.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "simulator/plant/test/forces.hpp"
#include "simulator/plant/test/plants.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kStep = 0.5e-3;  // s

bool same(const RigidBodyState& a, const RigidBodyState& b) {
  return a.p_NB_N == b.p_NB_N && a.q_NB.coeffs() == b.q_NB.coeffs() && a.v_NB_N == b.v_NB_N &&
         a.w_NB_B == b.w_NB_B;
}

Matrix3 diagonal(double x, double y, double z) {
  return Vector3(x, y, z).asDiagonal();
}

template <class Engine>
class PlantContractTest : public ::testing::Test {
 protected:
  std::unique_ptr<Plant> plant_ = Engine::make(reference_multirotor(), FieldParams{});
};

TYPED_TEST_SUITE(PlantContractTest, Plants, PlantName);

/// Leads down to the ground and up again, so that contact and its memory take part.
RigidBodyState hop(Plant& plant, int steps) {
  RigidBodyState state;
  state.p_NB_N.z() = -0.3;
  state.q_NB = Quaternion(0.99, 0.02, 0.03, 0.1);
  HeldForceInN forces;
  plant.reset(state, RotorSpeeds::Zero());
  for (int i = 0; i < steps; ++i) {
    forces.F_N.z() = i < 800 ? 0.0 : -50.0;
    plant.step(kStep, forces);
  }
  return plant.state();
}

TYPED_TEST(PlantContractTest, ForgetsThePastWhenItIsReset) {
  const RigidBodyState first = hop(*this->plant_, 1500);
  EXPECT_TRUE(same(hop(*this->plant_, 1500), first));
}

TYPED_TEST(PlantContractTest, DoesNotMindOthersOfItsKind) {
  const RigidBodyState alone = hop(*this->plant_, 1500);
  const std::unique_ptr<Plant> other = TypeParam::make(reference_multirotor(), FieldParams{});
  HeldWrench push;
  push.wrench.M_Bcm_B.x() = 0.1;
  RigidBodyState start;
  start.p_NB_N.z() = -0.3;
  start.q_NB = Quaternion(0.99, 0.02, 0.03, 0.1);
  HeldForceInN forces;
  this->plant_->reset(start, RotorSpeeds::Zero());
  for (int i = 0; i < 1500; ++i) {
    forces.F_N.z() = i < 800 ? 0.0 : -50.0;
    this->plant_->step(kStep, forces);
    other->step(kStep, push);
  }
  EXPECT_TRUE(same(this->plant_->state(), alone));
}

TYPED_TEST(PlantContractTest, TouchesTheGroundTheSameInAnyThread) {
  const RigidBodyState alone = hop(*this->plant_, 1500);
  RigidBodyState ends[2];
  const std::unique_ptr<Plant> plants[2] = {TypeParam::make(reference_multirotor(), FieldParams{}),
                                            TypeParam::make(reference_multirotor(), FieldParams{})};
  std::thread first([&] { ends[0] = hop(*plants[0], 1500); });
  std::thread second([&] { ends[1] = hop(*plants[1], 1500); });
  first.join();
  second.join();
  EXPECT_TRUE(same(ends[0], alone));
  EXPECT_TRUE(same(ends[1], alone));
}

TYPED_TEST(PlantContractTest, KeepsItsStateWhenTheMassChanges) {
  RigidBodyState state;
  state.p_NB_N = {1.0, -2.0, -30.0};
  state.v_NB_N = {3.0, 1.0, -2.0};
  state.w_NB_B = {0.3, -0.2, 0.1};
  this->plant_->configure({3.0, diagonal(0.08, 0.08, 0.12)}, kGravity);
  this->plant_->reset(state, RotorSpeeds::Zero());
  HeldForceInN lift;
  lift.F_N.z() = -30.0;
  for (int i = 0; i < 100; ++i) this->plant_->step(kStep, lift);
  const RigidBodyState before = this->plant_->state();
  this->plant_->configure({2.0, diagonal(0.08, 0.08, 0.12)}, kGravity);
  EXPECT_TRUE(same(this->plant_->state(), before));
  this->plant_->step(kStep, lift);
  const double a_down = (this->plant_->state().v_NB_N.z() - before.v_NB_N.z()) / kStep;
  constexpr double kRounding = 1e-10;
  EXPECT_NEAR(a_down, kGravity - 30.0 / 2.0, kRounding);
}

TYPED_TEST(PlantContractTest, KnowsProductsOfInertia) {
  Matrix3 J;
  J << 0.08, -0.01, 0.02, -0.01, 0.09, -0.005, 0.02, -0.005, 0.12;
  const Vector3 w(1.0, -2.0, 3.0);
  HeldWrench push;
  push.wrench.M_Bcm_B = {0.3, 0.1, -0.2};
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  state.w_NB_B = w;
  this->plant_->configure({3.5, J}, kGravity);
  this->plant_->reset(state, RotorSpeeds::Zero());
  constexpr double kShort = 1e-6;  // s
  this->plant_->step(kShort, push);
  const Vector3 euler = J.inverse() * (push.wrench.M_Bcm_B - w.cross(J * w));
  constexpr double kCurvature =
      1e-3;  // rad/s^2: second derivative times the step, and rounding over the step
  EXPECT_LT(((this->plant_->state().w_NB_B - w) / kShort - euler).norm(), kCurvature);
}

TYPED_TEST(PlantContractTest, MovesRotorSpeedsWithTheirRates) {
  struct Lag : ForceModel {
    Forces evaluate(const RigidBodyState&, const RotorSpeeds& rotors, double) override {
      Forces forces;
      forces.rotor_acceleration.head<4>() = (400.0 - rotors.head<4>()) / 0.035;
      return forces;
    }
    void settle(const RigidBodyState&, RotorSpeeds& rotors) override { rotors[7] = 7.0; }
  } lag;
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  this->plant_->reset(state, RotorSpeeds::Zero());
  for (int i = 0; i < 70; ++i) this->plant_->step(kStep, lag);
  constexpr double kSecondOrder = 0.01;  // rad/s: (h/lag)^2/6 of 400 rad/s over one lag
  EXPECT_NEAR(this->plant_->rotors()[3], 400.0 * (1.0 - std::exp(-1.0)), kSecondOrder);
  EXPECT_EQ(this->plant_->rotors()[7], 7.0);
}

TYPED_TEST(PlantContractTest, TakesATickInOneStepHighInTheAir) {
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  this->plant_->reset(state, RotorSpeeds::Zero());
  EXPECT_GE(this->plant_->contact_step(), 2.5e-3);
}

TYPED_TEST(PlantContractTest, SaysSoWhenItsStateIsNoNumber) {
  HeldWrench broken;
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  this->plant_->reset(state, RotorSpeeds::Zero());
  this->plant_->step(kStep, broken);
  EXPECT_EQ(this->plant_->failure(), nullptr);
  broken.wrench.F_Bcm_B.x() = std::numeric_limits<double>::quiet_NaN();
  this->plant_->step(kStep, broken);
  this->plant_->step(kStep, broken);
  EXPECT_NE(this->plant_->failure(), nullptr);
  this->plant_->reset(state, RotorSpeeds::Zero());
  EXPECT_EQ(this->plant_->failure(), nullptr);
}

TYPED_TEST(PlantContractTest, FliesTheSameWithContactOnAndOff) {
  // Bouncing on a column of air just above the ground goes in and out of reach; without a ground nothing ever
  // is.
  struct Cushion : ForceModel {
    Forces evaluate(const RigidBodyState& state, const RotorSpeeds&, double) override {
      Forces forces;
      const double lift = 3.5 * kGravity + 40.0 * (state.p_NB_N.z() + 1.0);
      forces.wrench.F_Bcm_B = state.q_NB.conjugate() * Vector3(0.1, 0.2, -lift);
      forces.wrench.M_Bcm_B = {0.01, -0.02, 0.03};
      return forces;
    }
  } cushion;
  FieldParams nothing;
  nothing.ground = false;
  const std::unique_ptr<Plant> free = TypeParam::make(reference_multirotor(), nothing);
  RigidBodyState state;
  state.p_NB_N.z() = -1.6;
  state.q_NB = Quaternion(0.99, 0.02, 0.03, 0.1);
  for (Plant* plant : {this->plant_.get(), free.get()}) plant->reset(state, RotorSpeeds::Zero());
  int near = 0;
  for (int i = 0; i < 4000; ++i) {
    this->plant_->step(kStep, cushion);
    free->step(kStep, cushion);
    ASSERT_TRUE(same(this->plant_->state(), free->state())) << "after step " << i;
    near += this->plant_->contact_step() < 1e-3;
  }
  if (std::string(TypeParam::kName) != "Own") {
    EXPECT_GT(near, 400);
    EXPECT_LT(near, 3600);
  }
}

}  // namespace
}  // namespace ironbird::simulator
