#include "simulator/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "simulator/plant/mujoco_plant.hpp"
#include "simulator/plant/ode_plant.hpp"
#include "simulator/plant/rigid_body_plant.hpp"
#include "simulator/test/test_vehicle.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kDt = 0.0025;

WorldConfig in_the_air() {
  WorldConfig config;
  config.vehicle = test_vehicle();
  config.initial_p_NB_N = Vector3(0.0, 0.0, -20.0);
  config.on_ground = false;
  return config;
}

World make_world(const WorldConfig& config) {
  return World(config, std::make_unique<RigidBodyPlant>());
}

void fly(World& world, const RotorCommands& commands, int ticks) {
  for (int i = 0; i < ticks; ++i) world.step(commands, world.truth().stamp + kTick);
}

/// A plant that only counts its steps.
class CountingPlant final : public Plant {
 public:
  CountingPlant(double contact_step, std::vector<double>& steps)
      : contact_step_(contact_step), steps_(steps) {}
  void configure(const MassProperties&, double) override {}
  void reset(const RigidBodyState& state, const RotorSpeeds& rotors) override {
    state_ = state;
    rotors_ = rotors;
  }
  void step(double dt, ForceModel&) override { steps_.push_back(dt); }
  const RigidBodyState& state() const override { return state_; }
  const RotorSpeeds& rotors() const override { return rotors_; }
  bool in_contact() const override { return false; }
  double contact_step() const override { return contact_step_; }

 private:
  double contact_step_;
  std::vector<double>& steps_;
  RigidBodyState state_;
  RotorSpeeds rotors_ = RotorSpeeds::Zero();
};

/// The own integrator, made to step as finely as asked.
class FinePlant final : public Plant {
 public:
  explicit FinePlant(double contact_step) : contact_step_(contact_step) {}
  void configure(const MassProperties& mass, double gravity) override { plant_.configure(mass, gravity); }
  void reset(const RigidBodyState& state, const RotorSpeeds& rotors) override { plant_.reset(state, rotors); }
  void step(double dt, ForceModel& forces) override { plant_.step(dt, forces); }
  const RigidBodyState& state() const override { return plant_.state(); }
  const RotorSpeeds& rotors() const override { return plant_.rotors(); }
  bool in_contact() const override { return false; }
  double contact_step() const override { return contact_step_; }

 private:
  double contact_step_;
  RigidBodyPlant plant_;
};

struct StepCase {
  const char* name;
  double contact_step;
  std::size_t steps;
};

class PlantStepTest : public ::testing::TestWithParam<StepCase> {};

TEST_P(PlantStepTest, DividesTheTickIntoEqualWholeNanoseconds) {
  std::vector<double> steps;
  World world(in_the_air(), std::make_unique<CountingPlant>(GetParam().contact_step, steps));
  world.step(all(0.0), kTick);
  ASSERT_EQ(steps.size(), GetParam().steps);
  for (const double dt : steps) EXPECT_EQ(dt, kDt / static_cast<double>(GetParam().steps));
  EXPECT_LE(steps[0], GetParam().contact_step);
}

INSTANTIATE_TEST_SUITE_P(ContactSteps, PlantStepTest,
                         ::testing::Values(StepCase{"Any", std::numeric_limits<double>::infinity(), 1},
                                           StepCase{"OneTick", 2.5e-3, 1}, StepCase{"Fifth", 0.5e-3, 5},
                                           StepCase{"ThreeDoNotDivide", 0.9e-3, 4},
                                           StepCase{"SevenDoNotDivide", 0.38e-3, 8}),
                         [](const auto& sample) { return sample.param.name; });

TEST(WorldTest, FliesTheSameWithFinePlantSteps) {
  World coarse = make_world(in_the_air());
  World fine(in_the_air(), std::make_unique<FinePlant>(0.5e-3));
  const double hover = coarse.vehicle().equilibrium_command();
  RotorCommands commands = all(hover);
  for (int i = 0; i < 400; ++i) {
    commands.throttle[0] = hover + 0.05 * std::sin(0.05 * i);
    coarse.step(commands, (i + 1) * kTick);
    fine.step(commands, (i + 1) * kTick);
  }
  // The battery is booked once per plant step: first order in the step, and tiny.
  constexpr double kStepTolerance = 1e-5;  // m
  EXPECT_GT((coarse.truth().p_NB_N - in_the_air().initial_p_NB_N).norm(), 0.1);
  EXPECT_NEAR((coarse.truth().p_NB_N - fine.truth().p_NB_N).norm(), 0.0, kStepTolerance);
}

TEST(WorldTest, HoversAtTheEquilibriumCommand) {
  WorldConfig config = in_the_air();
  config.initial_p_NB_N.z() = 0.0;  // where the equilibrium is defined
  World world = make_world(config);
  fly(world, all(world.vehicle().equilibrium_command()), 400);
  // The battery's voltage falls a little within the second.
  EXPECT_LT(world.truth().v_NB_N.norm(), 0.02);
  EXPECT_NEAR(world.truth().f_B.z(), -9.80665, 0.02);
  EXPECT_EQ(world.truth().stamp, 400 * kTick);
  EXPECT_GT(world.truth().battery_charge_used, 0.0);
}

TEST(WorldTest, FeelsNothingInFreeFall) {
  WorldConfig config = in_the_air();
  config.on_ground = true;  // rotors at rest; the plant has no ground
  config.vehicle.drag = DragParams{};
  World world = make_world(config);
  fly(world, all(0.0), 400);
  constexpr double kRoundOff = 1e-9;
  EXPECT_NEAR(world.truth().f_B.norm(), 0.0, kRoundOff);
  EXPECT_NEAR(world.truth().v_NB_N.z(), 9.80665, kRoundOff);
}

TEST(WorldTest, ReportsTheMeanSpecificForceAndAngularAccelerationOfTheTick) {
  World world = make_world(in_the_air());
  RotorCommands commands = all(world.vehicle().equilibrium_command());
  commands.throttle[0] += 0.1;
  fly(world, commands, 40);
  for (int i = 0; i < 40; ++i) {
    const Truth before = world.truth();
    fly(world, commands, 1);
    const Truth& after = world.truth();
    const Vector3 gravity_N(0.0, 0.0, 9.80665);
    const Vector3 impulse_N = (after.v_NB_N - before.v_NB_N) / kDt - gravity_N;
    // Between the body axes at both ends; the norm does not depend on axes at all.
    EXPECT_NEAR(after.f_B.norm(), impulse_N.norm(), 1e-9);
    const Vector3 at_start = before.q_NB.conjugate() * impulse_N;
    const Vector3 at_end = after.q_NB.conjugate() * impulse_N;
    EXPECT_NEAR((after.f_B - 0.5 * (at_start + at_end)).norm(), 0.0, 1e-4);
    EXPECT_EQ(after.w_dot_NB_B, Vector3((after.w_NB_B - before.w_NB_B) / kDt));
  }
  EXPECT_GT(world.truth().w_NB_B.norm(), 0.1);
}

TEST(WorldTest, TakesManyTicksAtOnceAsOneByOne) {
  World one_by_one = make_world(in_the_air()), at_once = make_world(in_the_air());
  fly(one_by_one, all(0.6), 40);
  at_once.step(all(0.6), 40 * kTick);
  EXPECT_EQ(one_by_one.truth().p_NB_N, at_once.truth().p_NB_N);
  EXPECT_EQ(one_by_one.readings().imu->f_B, at_once.readings().imu->f_B);
  EXPECT_EQ(at_once.readings().gnss->taken, 40 * kTick);
  EXPECT_EQ(at_once.readings().imu->taken, 40 * kTick);
}

TEST(WorldTest, RefusesParametersThatMakeNoSense) {
  WorldConfig heavy = in_the_air(), rate = in_the_air(), tick = in_the_air();
  heavy.vehicle.mass = -1.0;
  rate.sensors.imu.timing.rate = 300.0;
  tick.tick = Time::zero();
  EXPECT_THROW(make_world(heavy), std::invalid_argument);
  EXPECT_THROW(make_world(rate), std::invalid_argument);
  EXPECT_THROW(make_world(tick), std::invalid_argument);
}

TEST(WorldTest, GivesTheSensorsItsHome) {
  WorldConfig config = in_the_air();
  config.environment.home = {.latitude = 0.5, .longitude = 0.25, .altitude = 300.0};
  World world = make_world(config);
  world.step(all(0.0), 40 * kTick);
  constexpr double kTenMetres = 2e-6;  // rad
  EXPECT_NEAR(world.readings().gnss->latitude, 0.5, kTenMetres);
  EXPECT_NEAR(world.readings().gnss->longitude, 0.25, kTenMetres);
  EXPECT_NEAR(world.readings().baro->pressure, world.environment().pressure(-world.truth().p_NB_N.z()), 1e-9);
}

TEST(WorldTest, PassesArmingOnToTheSensors) {
  WorldConfig config = in_the_air();
  config.sensors.imu.noise_only_when_armed = true;
  config.sensors.imu.gyro.noise_sigma = 1.0;
  World world = make_world(config);
  world.step(all(0.5), kTick);
  EXPECT_EQ(world.readings().imu->w_NB_B, world.truth().w_NB_B);
  world.set_armed(true);
  world.step(all(0.5), 2 * kTick);
  EXPECT_NE(world.readings().imu->w_NB_B, world.truth().w_NB_B);
}

TEST(WorldFaultTest, BlowsFromOneSideUntilTheFaultEnds) {
  World world = make_world(in_the_air());
  const int first = world.begin({.kind = FaultKind::kWind, .vector = Vector3(3.0, 0.0, 0.0)});
  const int second = world.begin({.kind = FaultKind::kWind, .vector = Vector3(0.0, 4.0, 0.0)});
  fly(world, all(0.5), 1);
  EXPECT_EQ(world.truth().wind_N, Vector3(3.0, 4.0, 0.0));
  world.end(first);
  fly(world, all(0.5), 1);
  EXPECT_EQ(world.truth().wind_N, Vector3(0.0, 4.0, 0.0));
  world.end(second);
  fly(world, all(0.5), 1);
  EXPECT_EQ(world.truth().wind_N, Vector3(0.0, 0.0, 0.0));
}

TEST(WorldFaultTest, RollsAwayFromALostRotorsSide) {
  World world = make_world(in_the_air());
  world.begin({.kind = FaultKind::kRotorLoss, .index = 0});  // front right
  fly(world, all(world.vehicle().equilibrium_command()), 100);
  EXPECT_GT(world.truth().w_NB_B.x(), 0.5);   // right side down
  EXPECT_LT(world.truth().w_NB_B.y(), -0.5);  // nose down
  EXPECT_LT(world.truth().rotor_speed[0], world.truth().rotor_speed[1]);
}

TEST(WorldFaultTest, WeakensARotorByItsEfficiencyOnlyWhileTheFaultLasts) {
  WorldConfig config = in_the_air();
  config.vehicle.rotor.inertia = 0.0;
  config.vehicle.drag = DragParams{};
  World world = make_world(config);
  const double hover = world.vehicle().equilibrium_command();
  fly(world, all(hover), 1);
  const double healthy = world.truth().f_B.z();
  std::vector<int> ids;
  for (int rotor = 0; rotor < 4; ++rotor) {
    ids.push_back(world.begin({.kind = FaultKind::kRotorEfficiency, .index = rotor, .magnitude = 0.5}));
  }
  fly(world, all(hover), 1);
  EXPECT_NEAR(world.truth().f_B.z() / healthy, 0.5, 0.01);
  for (const int id : ids) world.end(id);
  fly(world, all(hover), 1);
  EXPECT_NEAR(world.truth().f_B.z() / healthy, 1.0, 0.02);
}

TEST(WorldFaultTest, CarriesPayloadsUntilTheyAreDropped) {
  World world = make_world(in_the_air());
  const double empty = world.vehicle().mass_properties().mass;
  const int first = world.begin({.kind = FaultKind::kPayload, .magnitude = 0.5});
  const int second = world.begin({.kind = FaultKind::kPayload, .magnitude = 0.25});
  EXPECT_DOUBLE_EQ(world.vehicle().mass_properties().mass, empty + 0.75);
  fly(world, all(world.vehicle().equilibrium_command()), 40);
  const double loaded = world.truth().f_B.z();
  world.end(first);
  world.end(second);
  EXPECT_DOUBLE_EQ(world.vehicle().mass_properties().mass, empty);
  fly(world, all(0.5), 1);
  EXPECT_LT(world.truth().f_B.z(), 1.1 * loaded);  // the same thrust lifts less: more upwards
}

TEST(WorldFaultTest, EmptiesTheBatteryOnce) {
  World world = make_world(in_the_air());
  fly(world, all(0.5), 10);
  const double full = world.truth().battery_voltage;
  const int id = world.begin({.kind = FaultKind::kBatteryCharge, .magnitude = 0.1});
  fly(world, all(0.5), 1);
  const double low = world.truth().battery_voltage;
  EXPECT_LT(low, full - 1.0);
  world.end(id);
  fly(world, all(0.5), 1);
  EXPECT_NEAR(world.truth().battery_voltage, low, 0.1);
}

TEST(WorldFaultTest, CannotHoverOnAnEmptyBattery) {
  World world = make_world(in_the_air());
  world.begin({.kind = FaultKind::kBatteryCharge, .magnitude = 0.0});
  fly(world, all(1.0), 20.0 / 0.0025);
  EXPECT_GT(world.truth().v_NB_N.z(), 10.0) << "m/s: at full throttle it falls";
}

TEST(WorldFaultTest, ReachesTheSensors) {
  World world = make_world(in_the_air());
  const int bias = world.begin({.kind = FaultKind::kGyroBias, .vector = Vector3(0.1, 0.2, 0.3)});
  const int silence = world.begin({.kind = FaultKind::kGnssDropout});
  world.step(all(0.5), 40 * kTick);
  EXPECT_NEAR((world.readings().imu->w_NB_B - world.truth().w_NB_B - Vector3(0.1, 0.2, 0.3)).norm(), 0.0,
              1e-12);
  EXPECT_FALSE(world.readings().gnss);
  world.end(bias);
  world.end(silence);
  world.step(all(0.5), 80 * kTick);
  EXPECT_EQ(world.readings().imu->w_NB_B, world.truth().w_NB_B);
  EXPECT_TRUE(world.readings().gnss);
}

TEST(WorldFaultTest, RefusesARotorThatIsNotThereAndForgetsUnknownNumbers) {
  World world = make_world(in_the_air());
  EXPECT_THROW(world.begin({.kind = FaultKind::kRotorLoss, .index = 4}), std::invalid_argument);
  world.end(12345);
  fly(world, all(0.5), 1);
  EXPECT_EQ(world.faults().rotor_efficiency[0], 1.0);
}

class WorldOnGroundTest : public ::testing::TestWithParam<Engine> {};

WorldConfig on_the_ground() {
  WorldConfig config;
  config.vehicle = test_vehicle();
  config.initial_p_NB_N = Vector3(5.0, -3.0, -100.0);
  config.initial_heading = 2.0;
  return config;
}

TEST_P(WorldOnGroundTest, RestsFromTheFirstMoment) {
  const WorldConfig config = on_the_ground();
  World world(config, GetParam().make(config.vehicle, FieldParams{}));
  const ContactParams& contact = config.vehicle.contact;
  const double standing = contact.feet[0].z() + contact.foot_radius;
  constexpr double kSettled = 2e-3;  // m and m/s: soft contact sinks in a little
  EXPECT_EQ(world.truth().stamp, Time::zero());
  EXPECT_TRUE(world.truth().in_contact);
  EXPECT_NEAR(world.truth().p_NB_N.z(), -standing, kSettled);
  EXPECT_NEAR(world.truth().p_NB_N.x(), 5.0, kSettled);
  EXPECT_NEAR(world.truth().p_NB_N.y(), -3.0, kSettled);
  EXPECT_NEAR(2.0 * std::atan2(world.truth().q_NB.z(), world.truth().q_NB.w()), 2.0, kSettled);
  EXPECT_EQ(world.truth().battery_charge_used, 0.0);

  const Vector3 before = world.truth().p_NB_N;
  for (int i = 0; i < 400; ++i) {
    world.step(RotorCommands{}, (i + 1) * kTick);
    ASSERT_NEAR((world.truth().f_B - Vector3(0.0, 0.0, -9.80665)).norm(), 0.0, 0.05) << i;
  }
  EXPECT_LT((world.truth().p_NB_N - before).norm(), 1e-4);
  EXPECT_EQ(world.failure(), nullptr);
}

TEST_P(WorldOnGroundTest, TakesOff) {
  const WorldConfig config = on_the_ground();
  World world(config, GetParam().make(config.vehicle, FieldParams{}));
  const double lift = 1.2 * world.vehicle().equilibrium_command();
  for (int i = 0; i < 400; ++i) world.step(all(lift), (i + 1) * kTick);
  EXPECT_LT(world.truth().p_NB_N.z(), -1.0);
  EXPECT_FALSE(world.truth().in_contact);
  EXPECT_EQ(world.failure(), nullptr);
}

INSTANTIATE_TEST_SUITE_P(Engines, WorldOnGroundTest,
                         ::testing::Values(Engine{"Mujoco", make_mujoco_plant},
                                           Engine{"Ode", make_ode_plant}),
                         [](const auto& sample) { return sample.param.name; });

}  // namespace
}  // namespace ironbird::simulator
