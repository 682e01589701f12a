// What each engine may be wrong by in free flight when the wrench is held in body axes over the step, as a
// table of a study has it: so the engines are compared, and not what our stages add to them.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulator/plant/ode_body.hpp"
#include "simulator/plant/test/forces.hpp"
#include "simulator/plant/test/free_top.hpp"
#include "simulator/plant/test/plants.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kStep = 0.5e-3;     // s
constexpr double kControl = 2.0e-3;  // s, from one command to the next: a multiple of all steps
constexpr double kDuration = 10.0;   // s

/// ODE's own step, eight times in each: what it does in contact, and the first order that all plants must
/// beat.
class OdeInSubSteps final : public Plant {
 public:
  void configure(const MassProperties& mass, double gravity) override { body_.configure(mass, gravity); }
  void reset(const RigidBodyState& state, const RotorSpeeds&) override {
    state_ = state;
    body_.write(state);
  }
  void step(double dt, ForceModel& forces) override {
    constexpr int kSubSteps = 8;
    const Wrench wrench = forces.evaluate(state_, rotors_, 0.0).wrench;
    for (int i = 0; i < kSubSteps; ++i) {
      body_.step(dt / kSubSteps, state_.q_NB * wrench.F_Bcm_B, state_.q_NB * wrench.M_Bcm_B, true);
      state_ = body_.read();
    }
  }
  const RigidBodyState& state() const override { return state_; }
  const RotorSpeeds& rotors() const override { return rotors_; }
  bool in_contact() const override { return false; }

 private:
  OdeBody body_{reference_multirotor().contact, FieldParams{}};
  RigidBodyState state_;
  RotorSpeeds rotors_ = RotorSpeeds::Zero();
};

struct SubSteps {
  static constexpr const char* kName = "SubSteps";
  static constexpr double kLeastOrder = 0.9;
  static constexpr double kMostOrder = 1.1;
  static constexpr double kFlightPosition = 1e-3;
  static constexpr double kFlightAttitude = 0.05 * kDegree;
  static constexpr double kTumbleEnergy = 5e-3;
  static constexpr double kTumbleMomentum = 2e-3;
  static std::unique_ptr<Plant> make(const VehicleParams&, const FieldParams&) {
    return std::make_unique<OdeInSubSteps>();
  }
};

Matrix3 diagonal(double x, double y, double z) {
  return Vector3(x, y, z).asDiagonal();
}

double angle_between(const Quaternion& a, const Quaternion& b) {
  return 2.0 * std::asin(std::min(1.0, (a.conjugate() * b).vec().norm()));
}

template <class Engine>
class EngineBoundsTest : public ::testing::Test {
 protected:
  std::unique_ptr<Plant> plant_ =
      Engine::make(reference_multirotor(), FieldParams{.ground = false, .boxes = {}});

  /// Without force and gravity. @param each  called with the number of steps so far
  template <class Each>
  void tumble(const Matrix3& J, const Vector3& w, Each&& each) {
    RigidBodyState state;
    state.p_NB_N.z() = -50.0;
    state.w_NB_B = w;
    plant_->configure({3.5, J}, 0.0);
    plant_->reset(state, RotorSpeeds::Zero());
    HeldWrench nothing;
    for (int i = 1; i <= std::lround(kDuration / kStep); ++i) {
      plant_->step(kStep, nothing);
      each(i);
    }
  }
};

using EnginesAndSubSteps = ::testing::Types<Own, Mujoco, Ode, SubSteps>;
TYPED_TEST_SUITE(EngineBoundsTest, EnginesAndSubSteps, PlantName);

/// The figure of eight under a control that is asked in each of its periods only, the wrench held in between.
/// About the origin: 50 m away the rounding of the position hides the fourth order at 0.5 ms.
std::vector<RigidBodyState> fly_held(Plant& plant, double dt) {
  const MassProperties mass{3.5, diagonal(0.08, 0.08, 0.12)};
  FigureOfEight control(mass.mass, mass.J_Bcm_B, 0.0);
  HeldWrench held;
  RotorSpeeds rotors = control.hover();
  plant.configure(mass, kGravity);
  plant.reset(control.start(), rotors);
  const int steps = static_cast<int>(std::lround(kControl / dt));
  std::vector<RigidBodyState> states;
  for (int i = 0; i < std::lround(kDuration / kControl); ++i) {
    control.set_start(i * kControl);
    const Forces forces = control.evaluate(plant.state(), rotors, 0.0);
    held.wrench = forces.wrench;
    rotors += kControl * forces.rotor_acceleration;
    for (int j = 0; j < steps; ++j) plant.step(dt, held);
    states.push_back(plant.state());
  }
  return states;
}

struct Difference {
  double position = 0.0;
  double attitude = 0.0;
};

Difference from_oracle(const std::vector<RigidBodyState>& flight) {
  static const std::vector<RigidBodyState> oracle = [] {
    RigidBodyPlant plant;
    return fly_held(plant, 0.125e-3);
  }();
  Difference most;
  for (std::size_t i = 0; i < flight.size(); ++i) {
    most.position = std::max(most.position, (flight[i].p_NB_N - oracle[i].p_NB_N).norm());
    most.attitude = std::max(most.attitude, angle_between(flight[i].q_NB, oracle[i].q_NB));
  }
  return most;
}

TYPED_TEST(EngineBoundsTest, FliesAsTheOracleDoesOnAHeldWrench) {
  const Difference difference = from_oracle(fly_held(*this->plant_, kStep));
  EXPECT_LT(difference.position, TypeParam::kFlightPosition);
  EXPECT_LT(difference.attitude, TypeParam::kFlightAttitude);
}

TYPED_TEST(EngineBoundsTest, GainsItsOrderOnAHeldWrench) {
  std::vector<double> errors;
  for (const double dt : {2e-3, 1e-3, 0.5e-3}) {
    errors.push_back(from_oracle(fly_held(*this->plant_, dt)).position);
  }
  for (const double order : {std::log2(errors[0] / errors[1]), std::log2(errors[1] / errors[2])}) {
    EXPECT_GT(order, TypeParam::kLeastOrder);
    EXPECT_LT(order, TypeParam::kMostOrder);
  }
}

TYPED_TEST(EngineBoundsTest, TumblesWithoutLosingEnergyOrAngularMomentum) {
  const Matrix3 J = diagonal(0.08, 0.08, 0.12);
  const Vector3 w(3.0, 5.0, 7.0);
  const double energy = w.dot(J * w);
  const Vector3 L_N = J * w;
  double most_energy = 0.0, most_momentum = 0.0;
  this->tumble(J, w, [&](int) {
    const RigidBodyState& now = this->plant_->state();
    const Vector3 L = J * now.w_NB_B;
    most_energy = std::max(most_energy, std::abs(now.w_NB_B.dot(L) / energy - 1.0));
    most_momentum = std::max(most_momentum, (now.q_NB * L - L_N).norm() / L_N.norm());
  });
  EXPECT_LT(most_energy, TypeParam::kTumbleEnergy);
  EXPECT_LT(most_momentum, TypeParam::kTumbleMomentum);
}

template <class Engine>
class FreeTopTest : public EngineBoundsTest<Engine> {};

TYPED_TEST_SUITE(FreeTopTest, Plants, PlantName);

TYPED_TEST(FreeTopTest, IsTurnedAsTheClosedFormSaysWhenItFlips) {
  const Vector3 J(0.06, 0.08, 0.12);
  const Vector3 w(0.05, 4.0, 0.05);
  const FreeTop top(J, w);
  double most_attitude = 0.0;
  this->tumble(J.asDiagonal(), w, [&](int steps) {
    if (steps % 1000 != 0) return;  // twice a second: the closed form takes an integral
    const Quaternion expected = top.turned(steps * kStep);
    most_attitude = std::max(most_attitude, angle_between(this->plant_->state().q_NB, expected));
  });
  EXPECT_LT(most_attitude, TypeParam::kFlipAttitude);
}

}  // namespace
}  // namespace ironbird::simulator
