// What every plant does in the air: closed forms first, then the observed order, then agreement with the
// oracle.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulator/plant/test/forces.hpp"
#include "simulator/plant/test/free_top.hpp"
#include "simulator/plant/test/plants.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kStep = 0.5e-3;  // s

Matrix3 diagonal(double x, double y, double z) {
  return Vector3(x, y, z).asDiagonal();
}

double angle_between(const Quaternion& a, const Quaternion& b) {
  return 2.0 * (a.conjugate() * b).vec().norm();  // small angles
}

template <class Engine>
class FlightTest : public ::testing::Test {
 protected:
  std::unique_ptr<Plant> plant_ = Engine::make(reference_multirotor(), FieldParams{});

  void begin(const RigidBodyState& state, double mass, const Matrix3& J, double gravity = kGravity) {
    plant_->configure({mass, J}, gravity);
    plant_->reset(state, RotorSpeeds::Zero());
  }
  void run(ForceModel& forces, int steps, double dt = kStep) {
    for (int i = 0; i < steps; ++i) plant_->step(dt, forces);
  }
};

TYPED_TEST_SUITE(FlightTest, Plants, PlantName);

TYPED_TEST(FlightTest, FallsAsGalileoSaid) {
  RigidBodyState state;
  state.p_NB_N = {1.0, 2.0, -500.0};
  state.v_NB_N = {3.0, -4.0, 5.0};
  state.q_NB = Quaternion(0.9, 0.1, -0.3, 0.2).normalized();
  this->begin(state, 3.5, diagonal(0.08, 0.08, 0.12));
  HeldWrench nothing;
  this->run(nothing, 4000);
  const double t = 4000 * kStep;
  const Vector3 fallen = state.p_NB_N + t * state.v_NB_N + Vector3(0.0, 0.0, 0.5 * kGravity * t * t);
  constexpr double kRounding = 1e-9;  // 4000 additions to 500 m
  EXPECT_LT((this->plant_->state().p_NB_N - fallen).norm(), kRounding);
  EXPECT_LT(angle_between(this->plant_->state().q_NB, state.q_NB), kRounding);
}

TYPED_TEST(FlightTest, ReachesItsTerminalVelocityAsTheClosedFormSays) {
  RigidBodyState state;
  state.p_NB_N = {0.0, 0.0, -500.0};
  this->begin(state, 3.5, diagonal(0.08, 0.08, 0.12));
  QuadraticDrag drag;
  drag.k = 0.05;
  this->run(drag, 20000);
  const double terminal = std::sqrt(3.5 * kGravity / drag.k);
  const double t = 20000 * kStep;
  const double fallen = terminal * terminal / kGravity * std::log(std::cosh(kGravity * t / terminal));
  EXPECT_NEAR(this->plant_->state().p_NB_N.z() + 500.0, fallen, TypeParam::kFall * 10.0);
  EXPECT_NEAR(this->plant_->state().v_NB_N.z(), terminal * std::tanh(kGravity * t / terminal),
              TypeParam::kFall);
}

TYPED_TEST(FlightTest, FlipsAboutItsIntermediateAxisOnTime) {
  const Vector3 J(0.06, 0.08, 0.12);
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  state.w_NB_B = {0.05, 4.0, 0.05};
  const double between_flips = FreeTop(J, state.w_NB_B).between_flips();

  this->begin(state, 3.5, J.asDiagonal(), 0.0);
  HeldWrench nothing;
  std::vector<double> flips;
  double before = state.w_NB_B.y();
  for (int i = 0; i < 60000; ++i) {
    this->run(nothing, 1);
    const double now = this->plant_->state().w_NB_B.y();
    if (before * now < 0.0) flips.push_back((i + before / (before - now)) * kStep);
    before = now;
  }
  ASSERT_GE(flips.size(), 2U);
  EXPECT_NEAR((flips[1] - flips[0]) / between_flips, 1.0, TypeParam::kFlipTime);
}

TYPED_TEST(FlightTest, HoldsStillUnderItsOwnWeight) {
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  this->begin(state, 3.5, diagonal(0.08, 0.08, 0.12));
  HeldWrench hover;
  hover.wrench.F_Bcm_B.z() = -3.5 * kGravity;
  this->run(hover, 20000);
  constexpr double kRounding = 1e-12;
  EXPECT_LT((this->plant_->state().p_NB_N - state.p_NB_N).norm(), kRounding);
}

/// Ten seconds of the figure of eight.
struct Flight {
  std::vector<RigidBodyState> states;  // every 0.1 s
};

Flight fly(Plant& plant, double dt, double duration) {
  const MassProperties mass{3.5, diagonal(0.08, 0.08, 0.12)};
  FigureOfEight forces(mass.mass, mass.J_Bcm_B);
  plant.configure(mass, kGravity);
  plant.reset(forces.start(), forces.hover());
  Flight flight;
  const int per_sample = static_cast<int>(std::lround(0.1 / dt));
  const int steps = static_cast<int>(std::lround(duration / dt));
  for (int i = 0; i < steps; ++i) {
    forces.set_start(i * dt);
    plant.step(dt, forces);
    if ((i + 1) % per_sample == 0) flight.states.push_back(plant.state());
  }
  return flight;
}

struct Difference {
  double position = 0.0;
  double attitude = 0.0;
};

Difference greatest(const Flight& a, const Flight& b) {
  Difference most;
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    most.position = std::max(most.position, (a.states[i].p_NB_N - b.states[i].p_NB_N).norm());
    most.attitude = std::max(most.attitude, angle_between(a.states[i].q_NB, b.states[i].q_NB));
  }
  return most;
}

const Flight& oracle() {
  static const Flight flight = [] {
    RigidBodyPlant plant;
    return fly(plant, 0.125e-3, 10.0);
  }();
  return flight;
}

TYPED_TEST(FlightTest, FliesAsTheOracleDoes) {
  const Difference difference = greatest(fly(*this->plant_, kStep, 10.0), oracle());
  EXPECT_LT(difference.position, TypeParam::kFlightPosition);
  EXPECT_LT(difference.attitude, TypeParam::kFlightAttitude);
}

TYPED_TEST(FlightTest, GainsTheOrderOfItsSchemeWhenTheStepIsHalved) {
  const double coarse = greatest(fly(*this->plant_, 4.0 * TypeParam::kFinest, 10.0), oracle()).position;
  const double medium = greatest(fly(*this->plant_, 2.0 * TypeParam::kFinest, 10.0), oracle()).position;
  const double fine = greatest(fly(*this->plant_, TypeParam::kFinest, 10.0), oracle()).position;
  for (const double order : {std::log2(coarse / medium), std::log2(medium / fine)}) {
    EXPECT_GT(order, TypeParam::kLeastOrder);
    EXPECT_LT(order, TypeParam::kMostOrder);
  }
}

/// Answers every stage of a step as the first one.
struct Held : ForceModel {
  ForceModel* forces = nullptr;
  Forces first;
  Forces evaluate(const RigidBodyState& state, const RotorSpeeds& rotors, double offset) override {
    if (offset == 0.0) first = forces->evaluate(state, rotors, offset);
    return first;
  }
};

TEST(HeldForcesTest, MakeAFourthOrderSchemeFirstOrder) {
  const auto error = [](double dt) {
    const MassProperties mass{3.5, diagonal(0.08, 0.08, 0.12)};
    FigureOfEight forces(mass.mass, mass.J_Bcm_B);
    Held held;
    held.forces = &forces;
    RigidBodyPlant plant;
    plant.configure(mass, kGravity);
    plant.reset(forces.start(), forces.hover());
    for (int i = 0; i < std::lround(10.0 / dt); ++i) {
      forces.set_start(i * dt);
      plant.step(dt, held);
    }
    return (plant.state().p_NB_N - oracle().states.back().p_NB_N).norm();
  };
  const double fine = error(0.5e-3);
  EXPECT_NEAR(std::log2(error(1e-3) / fine), 1.0, 0.1);
  constexpr double kThousandTimesTheStaged = 1e-8;  // m
  EXPECT_GT(fine, kThousandTimesTheStaged);
}

}  // namespace
}  // namespace ironbird::simulator
