// The ground and obstacles, for every plant that knows them.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/plant/test/forces.hpp"
#include "simulator/plant/test/plants.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kStep = 0.5e-3;  // s
constexpr double kFootRadius = 0.02;
constexpr double kFootDown = 0.2;                        // m, centres of the feet below the centre of mass
constexpr double kStance = 0.15;                         // m, half the distance of two feet
constexpr double kRestHeight = kFootDown + kFootRadius;  // m, of the centre of mass
constexpr double kSoftness = 1e-3;                       // m, how deep a resting foot may sink in
constexpr double kFriction = 0.4;

VehicleParams vehicle() {
  VehicleParams params = reference_multirotor();
  params.contact.friction = kFriction;
  return params;
}

double tilt(const Quaternion& q_NB) {
  return std::acos(std::clamp((q_NB * Vector3::UnitZ()).z(), -1.0, 1.0));
}

template <class Engine>
class ContactTest : public ::testing::Test {
 protected:
  FieldParams field_;
  std::unique_ptr<Plant> plant_;
  HeldForceInN forces_;

  void begin(const RigidBodyState& state) {
    plant_ = Engine::make(vehicle(), field_);
    plant_->configure({3.5, vehicle().inertia.matrix()}, kGravity);
    plant_->reset(state, RotorSpeeds::Zero());
  }
  void run(double duration) {
    const int steps = static_cast<int>(std::lround(duration / kStep));
    for (int i = 0; i < steps; ++i) plant_->step(kStep, forces_);
  }
  static RigidBodyState at_height(double height) {
    RigidBodyState state;
    state.p_NB_N.z() = -height;
    return state;
  }
};

TYPED_TEST_SUITE(ContactTest, PlantsWithContact, PlantName);

TYPED_TEST(ContactTest, StandsOnItsFeetAfterAFall) {
  this->begin(this->at_height(kRestHeight + 0.1));
  EXPECT_FALSE(this->plant_->in_contact());
  this->run(3.0);
  EXPECT_TRUE(this->plant_->in_contact());
  EXPECT_NEAR(-this->plant_->state().p_NB_N.z(), kRestHeight, kSoftness);
  EXPECT_LT(tilt(this->plant_->state().q_NB), 1e-6);
  EXPECT_EQ(this->plant_->failure(), nullptr);
}

TYPED_TEST(ContactTest, FeelsExactlyOneGravityAtRest) {
  this->begin(this->at_height(kRestHeight));
  this->run(3.0);
  constexpr double kNoise = 1e-9;  // m/s^2
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3 before = this->plant_->state().v_NB_N;
    this->run(kStep);
    const Vector3 a_N = (this->plant_->state().v_NB_N - before) / kStep;
    worst = std::max(worst, a_N.norm());
  }
  EXPECT_LT(worst, kNoise);
}

TYPED_TEST(ContactTest, StaysWhereItIsBelowTheLimitOfFriction) {
  this->begin(this->at_height(kRestHeight));
  this->run(2.0);
  const double before = this->plant_->state().p_NB_N.x();
  this->forces_.F_N.x() = 0.5 * kFriction * 3.5 * kGravity;
  this->run(2.0);
  constexpr double kCreep = 5e-3;  // m: soft contacts lean, and may creep
  EXPECT_NEAR(this->plant_->state().p_NB_N.x(), before, kCreep);
}

TYPED_TEST(ContactTest, SlidesWithWhatFrictionLeavesOver) {
  this->begin(this->at_height(kRestHeight));
  this->run(2.0);
  this->forces_.F_N.x() = 1.3 * kFriction * 3.5 * kGravity;
  this->run(0.5);  // let it lean into the slide
  const double v_before = this->plant_->state().v_NB_N.x();
  this->run(0.5);
  const double acceleration = (this->plant_->state().v_NB_N.x() - v_before) / 0.5;
  const double coulomb = 0.3 * kFriction * kGravity;
  EXPECT_NEAR(acceleration / coulomb, 1.0, 0.02);
}

/// Stands on the two right feet, leaning by `lean`, rad.
RigidBodyState leaning(double lean) {
  RigidBodyState state;
  state.q_NB = Quaternion(Eigen::AngleAxis<double>(lean, Vector3::UnitX()));
  const Vector3 foot_B(kStance, kStance, kFootDown);
  state.p_NB_N.z() = -(state.q_NB * foot_B).z() - kFootRadius;
  return state;
}

// The centre of mass is above the line of the right feet at atan(stance/height of the feet).
const double kTippingAngle = std::atan(kStance / kFootDown);

TYPED_TEST(ContactTest, FallsBackOnItsFeetBeforeTheTippingAngle) {
  this->begin(leaning(kTippingAngle - 0.1));
  this->run(6.0);
  EXPECT_LT(tilt(this->plant_->state().q_NB), 0.01);
}

TYPED_TEST(ContactTest, TipsOverBeyondTheTippingAngle) {
  this->begin(leaning(kTippingAngle + 0.1));
  this->run(6.0);
  EXPECT_GT(tilt(this->plant_->state().q_NB), 1.2);
  EXPECT_TRUE(this->plant_->in_contact());
  EXPECT_LT(this->plant_->state().v_NB_N.norm(), 1e-3);
}

TYPED_TEST(ContactTest, StandsOnABox) {
  this->field_.boxes.push_back({.position = {0.0, 0.0, -0.5}, .half_size = {1.0, 0.6, 0.5}, .heading = 0.3});
  this->begin(this->at_height(1.0 + kRestHeight + 0.05));
  this->run(3.0);
  EXPECT_NEAR(-this->plant_->state().p_NB_N.z(), 1.0 + kRestHeight, kSoftness);
}

TYPED_TEST(ContactTest, StopsAtAWall) {
  // A wall whose face is 2 m to the north-east, turned by an eighth.
  const double heading = std::numbers::pi / 4.0;
  const double c = std::cos(heading);
  this->field_.boxes.push_back(
      {.position = Vector3(2.5 * c, 2.5 * c, -3.0), .half_size = {0.5, 4.0, 3.0}, .heading = heading});
  RigidBodyState state = this->at_height(3.0);
  state.q_NB = Quaternion(Eigen::AngleAxis<double>(heading, Vector3::UnitZ()));
  this->begin(state);
  this->forces_.F_N = Vector3(2.0 * c, 2.0 * c, -3.5 * kGravity);
  this->run(8.0);
  const Vector3& p_N = this->plant_->state().p_NB_N;
  const double towards_wall = c * (p_N.x() + p_N.y());
  EXPECT_TRUE(this->plant_->in_contact());
  EXPECT_NEAR(towards_wall, 2.0 - vehicle().contact.body_half_size.x(), 0.01);
}

TYPED_TEST(ContactTest, AsksForShortStepsNearTheGround) {
  this->begin(this->at_height(kRestHeight));
  EXPECT_LE(this->plant_->contact_step(), 0.5e-3);
}

TYPED_TEST(ContactTest, RestsAsQuietlyInLongSteps) {
  this->begin(this->at_height(kRestHeight));
  this->run(3.0);
  const double height = -this->plant_->state().p_NB_N.z();
  constexpr double kLongStep = 2.5e-3;
  constexpr double kDrift = 1e-9;  // m
  constexpr double kNoise = 1e-9;  // m/s^2
  for (int i = 0; i < 2000; ++i) {
    ASSERT_GE(this->plant_->contact_step(), kLongStep);
    const Vector3 before = this->plant_->state().v_NB_N;
    this->plant_->step(kLongStep, this->forces_);
    ASSERT_LT((this->plant_->state().v_NB_N - before).norm() / kLongStep, kNoise);
  }
  EXPECT_NEAR(-this->plant_->state().p_NB_N.z(), height, kDrift);
}

TYPED_TEST(ContactTest, AsksForShortStepsAgainWhenItLeavesTheGround) {
  this->begin(this->at_height(kRestHeight));
  this->run(1.0);
  ASSERT_GE(this->plant_->contact_step(), 2.5e-3);
  this->forces_.F_N.z() = -1.2 * 3.5 * kGravity;
  this->run(0.1);
  EXPECT_LE(this->plant_->contact_step(), 0.5e-3);
}

}  // namespace
}  // namespace ironbird::simulator
