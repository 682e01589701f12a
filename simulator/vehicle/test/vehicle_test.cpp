#include "simulator/vehicle/vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "simulator/plant/rigid_body_plant.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kRounding = 1e-10;

EnvironmentParams still_air() {
  EnvironmentParams params;
  params.air.constant_density = true;
  params.air.density = 1.074;
  return params;
}

/// With rotors that have inertia and a battery that sags.
VehicleParams lagging() {
  VehicleParams params = reference_multirotor();
  params.rotor.inertia = 3e-4;
  params.rotor.resistance = 0.108;
  params.ground_effect.kind = GroundEffectKind::kNone;
  params.battery = {.cells = 6, .capacity = 36000.0, .initial_charge = 1.0, .resistance = 0.02};
  return params;
}

RotorCommands all(double command) {
  RotorCommands commands;
  commands.throttle.fill(command);
  return commands;
}

class VehicleTest : public ::testing::Test {
 protected:
  Environment environment_{still_air(), 1};
};

TEST_F(VehicleTest, IsInBalanceAtItsEquilibrium) {
  Vehicle vehicle(lagging(), environment_);
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  const Forces forces = vehicle.evaluate(RigidBodyState{}, vehicle.equilibrium_speeds(), 0.0);
  EXPECT_NEAR(forces.wrench.F_Bcm_B.z(), -3.5 * environment_.gravity(), kRounding);
  EXPECT_LT(forces.rotor_acceleration.abs().maxCoeff(), 1e-8);
  EXPECT_LT(forces.wrench.M_Bcm_B.norm(), kRounding);
}

struct MomentCase {
  const char* name;
  int rotor;      // that turns faster
  Vector3 signs;  // of the moment
};

class MomentTest : public ::testing::TestWithParam<MomentCase> {};

TEST_P(MomentTest, TurnsTheVehicleAwayFromTheFasterRotor) {
  const Environment environment(still_air(), 1);
  Vehicle vehicle(lagging(), environment);
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  RotorSpeeds speeds = vehicle.equilibrium_speeds();
  speeds[GetParam().rotor] *= 1.1;
  const Rotor rotor(lagging().rotor);
  const double speed = speeds[GetParam().rotor];
  const Vector3 M_B = vehicle.evaluate(RigidBodyState{}, speeds, 0.0).wrench.M_Bcm_B;
  const double extra = rotor.thrust(speed, 0.0, 1.074) - rotor.thrust(speed / 1.1, 0.0, 1.074);
  const double arm = 0.25 / std::sqrt(2.0);
  EXPECT_NEAR(M_B.x(), GetParam().signs.x() * arm * extra, kRounding);
  EXPECT_NEAR(M_B.y(), GetParam().signs.y() * arm * extra, kRounding);
}

// Front right, back right, back left, front left; roll right and pitch up are positive.
INSTANTIATE_TEST_SUITE_P(Rotors, MomentTest,
                         ::testing::Values(MomentCase{"FrontRight", 0, {-1, 1, 0}},
                                           MomentCase{"BackRight", 1, {-1, -1, 0}},
                                           MomentCase{"BackLeft", 2, {1, -1, 0}},
                                           MomentCase{"FrontLeft", 3, {1, 1, 0}}),
                         [](const auto& case_) { return case_.param.name; });

TEST_F(VehicleTest, YawsAgainstTheDirectionOfTheFasterPair) {
  // Instantaneous rotors 1 and 3 turn about +Bz; the air's torque on them is about -Bz and goes to the body.
  Vehicle vehicle(reference_multirotor(), environment_);
  RotorCommands commands = all(0.5);
  commands.throttle[1] = commands.throttle[3] = 0.55;
  vehicle.set_commands(commands);
  EXPECT_LT(vehicle.evaluate(RigidBodyState{}, RotorSpeeds::Zero(), 0.0).wrench.M_Bcm_B.z(), -0.01);
}

TEST_F(VehicleTest, KeepsTheAngularMomentumOfBodyAndRotorsWithoutAir) {
  // Without air the motors' torques are internal: what the body gains about Bz the rotors lose. A vacuum has
  // no density, so nothing else turns the vehicle.
  EnvironmentParams vacuum = still_air();
  vacuum.air.density = 0.0;
  const Environment environment(vacuum, 1);
  Vehicle vehicle(lagging(), environment);
  RotorCommands commands = all(0.3);
  commands.throttle[0] = 0.5;
  vehicle.set_commands(commands);
  RigidBodyPlant plant;
  plant.configure(vehicle.mass_properties(), 0.0);
  RigidBodyState state;
  state.w_NB_B = {0.4, -0.3, 0.2};
  plant.reset(
      state, RotorSpeeds::Constant(100.0) * (Eigen::Array<double, 8, 1>::LinSpaced(0, 7) < 4).cast<double>());
  const Matrix3 J = vehicle.mass_properties().J_Bcm_B;
  const auto momentum_N = [&] {
    const RotorSpeeds& w = plant.rotors();
    const double h = 3e-4 * (-w[0] + w[1] - w[2] + w[3]);
    return Vector3(plant.state().q_NB * (J * plant.state().w_NB_B + Vector3(0.0, 0.0, h)));
  };
  const Vector3 before = momentum_N();
  for (int i = 0; i < 1000; ++i) plant.step(0.5e-3, vehicle);
  EXPECT_GT(std::abs(plant.state().w_NB_B.z() - 0.2), 0.05);
  constexpr double kIntegration = 1e-9;
  EXPECT_LT((momentum_N() - before).norm(), kIntegration);
}

TEST_F(VehicleTest, LagsByItsInertiaOverMotorAndAirDamping) {
  // About hover the speed decays with J_r/(K_V^2/R + 2 Q/w); the ideal source keeps the battery out of it.
  VehicleParams params = lagging();
  params.battery.resistance = 0.0;
  Vehicle vehicle(params, environment_);
  const RotorSpeeds hover = vehicle.equilibrium_speeds();
  const Rotor rotor(params.rotor);
  const double damping = params.rotor.K_V * params.rotor.K_V / params.rotor.resistance +
                         2.0 * rotor.torque(hover[0], 0.0, 1.074) / hover[0];
  const double lag = params.rotor.inertia / damping;
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  RigidBodyPlant plant;
  plant.configure(vehicle.mass_properties(), environment_.gravity());
  plant.reset(RigidBodyState{}, hover * 1.001);
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i) plant.step(lag / kSteps, vehicle);
  const double left = (plant.rotors()[0] / hover[0] - 1.0) / 0.001;
  constexpr double kNonlinear = 1e-3;  // the square of the disturbance
  EXPECT_NEAR(left, std::exp(-1.0), kNonlinear);
}

TEST_F(VehicleTest, LetsTheRotorsRunDownWithoutCurrent) {
  Vehicle vehicle(lagging(), environment_);
  vehicle.set_commands(all(0.0));
  RigidBodyPlant plant;
  plant.configure(vehicle.mass_properties(), 0.0);
  plant.reset(RigidBodyState{}, vehicle.equilibrium_speeds());
  double last = plant.rotors()[0];
  for (int i = 0; i < 8000; ++i) {
    plant.step(0.5e-3, vehicle);
    vehicle.finish_step(0.5e-3, plant.state(), plant.rotors());
    ASSERT_LE(plant.rotors()[0], last);
    ASSERT_GE(plant.rotors()[0], 0.0);
    ASSERT_EQ(vehicle.battery_current(), 0.0);
    last = plant.rotors()[0];
  }
  EXPECT_LT(last, 0.1);
}

TEST_F(VehicleTest, StartsFromRestAndReachesItsEquilibrium) {
  Vehicle vehicle(lagging(), environment_);
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  RigidBodyPlant plant;
  plant.configure(vehicle.mass_properties(), environment_.gravity());
  plant.reset(RigidBodyState{}, RotorSpeeds::Zero());
  struct Held : ForceModel {
    Vehicle* vehicle;
    Forces evaluate(const RigidBodyState&, const RotorSpeeds& rotors, double offset) override {
      Forces forces = vehicle->evaluate(RigidBodyState{}, rotors, offset);
      forces.wrench = Wrench{};
      return forces;
    }
  } held_vehicle;
  held_vehicle.vehicle = &vehicle;
  for (int i = 0; i < 4000; ++i) plant.step(0.5e-3, held_vehicle);
  EXPECT_NEAR(plant.rotors()[2] / vehicle.equilibrium_speeds()[2], 1.0, 1e-6);
}

TEST_F(VehicleTest, SagsByItsInternalResistance) {
  Vehicle vehicle(lagging(), environment_);
  EXPECT_NEAR(vehicle.battery_voltage(), 6 * 4.2, kRounding);
  const RotorSpeeds hover = vehicle.equilibrium_speeds();
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  vehicle.finish_step(1e-9, RigidBodyState{}, hover);
  const double drop = 0.02 * vehicle.battery_current();
  EXPECT_GT(drop, 0.2);
  EXPECT_NEAR(vehicle.battery_voltage(), 6 * 4.2 - drop, kRounding);
}

TEST_F(VehicleTest, TakesFromTheBatteryWhatMotorsTurnIntoHeatAndWork) {
  Vehicle vehicle(lagging(), environment_);
  const RotorSpeeds hover = vehicle.equilibrium_speeds();
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  vehicle.finish_step(1e-9, RigidBodyState{}, hover);
  const RotorParams& p = vehicle.params().rotor;
  const Rotor rotor(p);
  const double torque = rotor.torque(hover[0], 0.0, 1.074);
  const double current = torque / p.K_V + p.no_load_current;
  const double friction = p.K_V * p.no_load_current * hover[0];
  const double heat = p.resistance * current * current;
  EXPECT_NEAR(vehicle.battery_voltage() * vehicle.battery_current(),
              4.0 * (torque * hover[0] + friction + heat), 1e-6);
}

TEST_F(VehicleTest, EmptiesItsBattery) {
  VehicleParams params = lagging();
  params.battery.capacity = 3600.0;
  Vehicle vehicle(params, environment_);
  vehicle.set_commands(all(0.5));
  const RotorSpeeds slow = 0.5 * vehicle.equilibrium_speeds();  // so that the motors always drive
  double charge = 0.0;
  double last_voltage = vehicle.battery_voltage();
  for (int i = 0; i < 200; ++i) {
    vehicle.finish_step(1.0, RigidBodyState{}, slow);
    charge += vehicle.battery_current();
    ASSERT_LE(vehicle.battery_voltage(), last_voltage);
    last_voltage = vehicle.battery_voltage();
  }
  EXPECT_NEAR(vehicle.battery_charge_used(), charge, 1e-9 * charge);
  EXPECT_LT(last_voltage, 6 * 3.3);
  // Beyond empty the voltage collapses within a hundredth of the capacity.
  vehicle.set_battery_charge(0.0);
  vehicle.finish_step(1e-6, RigidBodyState{}, slow);
  EXPECT_GT(vehicle.battery_voltage(), 6 * 3.0);
  charge = vehicle.battery_charge_used();
  for (int i = 0; i < 60; ++i) vehicle.finish_step(1.0, RigidBodyState{}, slow);
  EXPECT_LE(vehicle.battery_charge_used() - charge, 0.02 * params.battery.capacity) << "there is no more";
  EXPECT_LT(vehicle.battery_voltage(), 6 * 2.0);
}

TEST_F(VehicleTest, FollowsAChargeThatIsSet) {
  Vehicle vehicle(lagging(), environment_);
  vehicle.set_battery_charge(0.55);
  vehicle.finish_step(1e-9, RigidBodyState{}, RotorSpeeds::Zero());
  EXPECT_NEAR(vehicle.battery_voltage(), 6 * 0.5 * (3.79 + 3.83), kRounding);
}

TEST_F(VehicleTest, LosesARotor) {
  Vehicle vehicle(lagging(), environment_);
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  const RotorSpeeds hover = vehicle.equilibrium_speeds();
  const double whole = vehicle.evaluate(RigidBodyState{}, hover, 0.0).wrench.F_Bcm_B.z();
  vehicle.set_rotor_efficiency(2, 0.4);
  EXPECT_NEAR(vehicle.evaluate(RigidBodyState{}, hover, 0.0).wrench.F_Bcm_B.z(), whole * 3.4 / 4.0,
              kRounding);
  vehicle.set_rotor_efficiency(2, 0.0);
  const Forces dead = vehicle.evaluate(RigidBodyState{}, hover, 0.0);
  EXPECT_NEAR(dead.wrench.F_Bcm_B.z(), whole * 3.0 / 4.0, kRounding);
  const Rotor rotor(vehicle.params().rotor);
  const double drag = rotor.torque(hover[2], 0.0, 1.074) + 0.028937 * 1.5;  // air and friction
  EXPECT_NEAR(dead.rotor_acceleration[2], -drag / 3e-4, 1e-6);
  vehicle.set_rotor_efficiency(2, 1.0);
  EXPECT_NEAR(vehicle.evaluate(RigidBodyState{}, hover, 0.0).wrench.F_Bcm_B.z(), whole, kRounding);
}

TEST_F(VehicleTest, CarriesAPayload) {
  Vehicle vehicle(lagging(), environment_);
  vehicle.set_payload(0.5);
  EXPECT_EQ(vehicle.mass_properties().mass, 4.0);
  vehicle.set_payload(0.0);
  EXPECT_EQ(vehicle.mass_properties().mass, 3.5);
}

TEST_F(VehicleTest, TakesWhatIsNoCommandForNone) {
  Vehicle vehicle(reference_multirotor(), environment_);
  RotorCommands commands = all(2.0);
  vehicle.set_commands(commands);
  const double full = vehicle.evaluate(RigidBodyState{}, RotorSpeeds::Zero(), 0.0).wrench.F_Bcm_B.z();
  vehicle.set_commands(all(1.0));
  EXPECT_EQ(vehicle.evaluate(RigidBodyState{}, RotorSpeeds::Zero(), 0.0).wrench.F_Bcm_B.z(), full);
  vehicle.set_commands(all(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_NEAR(vehicle.evaluate(RigidBodyState{}, RotorSpeeds::Zero(), 0.0).wrench.F_Bcm_B.z(), 0.0, 1e-3);
}

TEST_F(VehicleTest, FeelsTheWindAndNotTheGround) {
  EnvironmentParams params = still_air();
  params.wind.steady_N = {3.0, 0.0, 0.0};
  const Environment windy(params, 1);
  Vehicle vehicle(lagging(), windy);
  RigidBodyState drifting;
  drifting.v_NB_N = {3.0, 0.0, 0.0};
  const RotorSpeeds hover = vehicle.equilibrium_speeds();
  EXPECT_NEAR(vehicle.evaluate(drifting, hover, 0.0).wrench.F_Bcm_B.x(), 0.0, kRounding);
  EXPECT_GT(vehicle.evaluate(RigidBodyState{}, hover, 0.0).wrench.F_Bcm_B.x(), 1.0);
}

TEST_F(VehicleTest, GainsThrustNearTheGroundAsCheesemanAndBennettSay) {
  VehicleParams params = lagging();
  params.ground_effect.kind = GroundEffectKind::kThrustProportional;
  Vehicle vehicle(params, environment_);
  const RotorSpeeds hover = vehicle.equilibrium_speeds();
  RigidBodyState state;
  state.p_NB_N.z() = -0.381;  // two radii
  EXPECT_NEAR(-vehicle.evaluate(state, hover, 0.0).wrench.F_Bcm_B.z() / (3.5 * environment_.gravity()),
              1.0 / (1.0 - 1.0 / 64.0), kRounding);
}

struct BadCase {
  const char* name;
  std::function<void(VehicleParams&)> spoil;
  const char* names;
};

class VehicleParamsTest : public ::testing::TestWithParam<BadCase> {};

TEST_P(VehicleParamsTest, RefusesWhatMakesNoSense) {
  const Environment environment(still_air(), 1);
  VehicleParams params = reference_multirotor();
  GetParam().spoil(params);
  try {
    const Vehicle vehicle(params, environment);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), ::testing::HasSubstr(GetParam().names));
    EXPECT_THAT(refusal.what(), ::testing::HasSubstr("must"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, VehicleParamsTest,
    ::testing::Values(
        BadCase{"NegativeMass", [](VehicleParams& p) { p.mass = -1.0; }, "vehicle.mass = -1"},
        BadCase{"MassNotANumber", [](VehicleParams& p) { p.mass = std::nan(""); }, "vehicle.mass"},
        BadCase{"NegativeInertia", [](VehicleParams& p) { p.inertia.Jyy = -0.1; }, "vehicle.inertia"},
        BadCase{"ProductsTooLarge", [](VehicleParams& p) { p.inertia.Jxy = 0.09; }, "vehicle.inertia"},
        BadCase{"NoTriangle", [](VehicleParams& p) { p.inertia.Jzz = 0.2; }, "vehicle.inertia"},
        BadCase{"NoRotors", [](VehicleParams& p) { p.rotors.clear(); }, "vehicle.rotors"},
        BadCase{"TooManyRotors", [](VehicleParams& p) { p.rotors.resize(9); }, "vehicle.rotors"},
        BadCase{"NoDirection", [](VehicleParams& p) { p.rotors[1].direction = 0; }, "rotors[1].direction"},
        BadCase{"RotorNowhere", [](VehicleParams& p) { p.rotors[2].position.y() = INFINITY; },
                "rotors[2].position"},
        BadCase{"NoThrust", [](VehicleParams& p) { p.rotor.CT[0] = 0.0; }, "vehicle.rotor.CT[0]"},
        BadCase{"NoDiameter", [](VehicleParams& p) { p.rotor.diameter = 0.0; }, "vehicle.rotor.diameter"},
        BadCase{"TwoFeet", [](VehicleParams& p) { p.contact.feet.resize(2); }, "vehicle.contact.feet"},
        BadCase{"FlatBox", [](VehicleParams& p) { p.contact.body_half_size.z() = 0.0; }, "body_half_size"},
        BadCase{"Overcharged", [](VehicleParams& p) { p.battery.initial_charge = 1.1; },
                "initial_charge = 1.1"}),
    [](const auto& case_) { return case_.param.name; });

}  // namespace
}  // namespace ironbird::simulator
