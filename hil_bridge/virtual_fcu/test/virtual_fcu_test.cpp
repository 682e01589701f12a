#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "hil_bridge/virtual_fcu/physical_mixer.hpp"
#include "simulator/plant/rigid_body_plant.hpp"

namespace ironbird::hil_bridge {
namespace {

constexpr Time kTick = std::chrono::microseconds(2500);

/// The reference vehicle in the air, with perfect sensors and an FCU whose mixer fits it.
class Flight {
 public:
  explicit Flight(const VirtualFcuConfig& config = fcu_config())
      : world(world_config(), std::make_unique<simulator::RigidBodyPlant>()), fcu(config, world) {}

  static simulator::WorldConfig world_config() {
    simulator::WorldConfig config;
    config.vehicle = simulator::reference_multirotor();
    config.vehicle.ground_effect.kind = simulator::GroundEffectKind::kNone;
    config.initial_p_NB_N = {0.0, 0.0, -50.0};
    config.on_ground = false;
    return config;
  }

  static VirtualFcuConfig fcu_config() {
    VirtualFcuConfig config;
    config.calibrate_imu_at_start = false;
    config.parameters = {{"PRIMARY_MIXER", 2},   {"FAILSAFE_THR", 0.3}, {"GYRO_X_BIAS", 1e-9},
                         {"RC_NUM_CHN", 8},      {"RC_ARM_CHN", 4},     {"RC_ATT_OVRD_CHN", 5},
                         {"RC_THR_OVRD_CHN", 5}, {"TAKE_MIN_THR", 0},   {"RC_MAX_THR", 1.0},
                         {"FILT_INIT_T", 0},     {"RC_OVRD_LAG_T", 0}};
    return config;
  }

  void advance(int ticks) {
    for (int k = 0; k < ticks; ++k) {
      time += kTick;
      fcu.advance(time);
      inbox.clear();
      fcu.receive(inbox);
      if (command) fcu.send(*command);
    }
  }

  simulator::World world;
  VirtualFcu fcu;
  std::vector<Arrival> inbox;
  std::optional<rosflight::OffboardControl> command;
  Time time{};
};

TEST(VirtualFcuTest, StepsTheWorldTickByTick) {
  Flight flight;
  flight.fcu.advance(10 * kTick);
  EXPECT_EQ(flight.world.truth().stamp, 10 * kTick);
  std::vector<Arrival> inbox;
  flight.fcu.receive(inbox);
  int imus = 0;
  for (const Arrival& a : inbox) imus += std::holds_alternative<rosflight::SmallImu>(a.message) ? 1 : 0;
  EXPECT_EQ(imus, 10);
}

TEST(VirtualFcuTest, TurnsTheRotorsOnlyWhenThePilotHasArmed) {
  Flight flight;
  flight.command = rosflight::OffboardControl{.u = {0, 0, 0.48F}, .ignore = 0, .mode = 2};
  flight.fcu.pilot().override_companion(false);
  flight.advance(40);
  EXPECT_EQ(flight.fcu.commands().throttle[0], 0.0);
  flight.fcu.pilot().override_companion(true);  // TAKE_MIN_THR is 0: needed for arming
  flight.fcu.pilot().arm(true);
  flight.advance(8);
  flight.fcu.pilot().override_companion(false);
  flight.advance(8);
  EXPECT_NEAR(flight.fcu.commands().throttle[0], 0.48, 0.02);
  flight.fcu.pilot().arm(false);
  flight.advance(8);
  EXPECT_EQ(flight.fcu.commands().throttle[0], 0.0);
}

TEST(VirtualFcuTest, HoldsTheAnglesOfTheCompanion) {
  Flight flight;
  flight.fcu.pilot().arm(true);
  flight.advance(8);
  flight.fcu.pilot().override_companion(false);
  flight.command = rosflight::OffboardControl{.u = {0, 0, 0.5F, 0.2F, -0.1F, 0.0F}, .ignore = 0, .mode = 2};
  flight.advance(400);
  const simulator::Truth& truth = flight.world.truth();
  const double roll =
      std::atan2(2.0 * (truth.q_NB.w() * truth.q_NB.x() + truth.q_NB.y() * truth.q_NB.z()),
                 1.0 - 2.0 * (truth.q_NB.x() * truth.q_NB.x() + truth.q_NB.y() * truth.q_NB.y()));
  const double pitch = std::asin(2.0 * (truth.q_NB.w() * truth.q_NB.y() - truth.q_NB.z() * truth.q_NB.x()));
  // A vehicle that flies freely feels its thrust along the body: the filter leans towards level by 0.5 1/s,
  // the truth follows, and the damping of that slow turn costs PID_ROLL_ANG_D / PID_ROLL_ANG_P of it.
  EXPECT_NEAR(roll, 0.2, 0.15);
  EXPECT_NEAR(static_cast<double>(flight.fcu.firmware().filter().attitude().roll()), 0.2, 0.03);
  EXPECT_NEAR(static_cast<double>(flight.fcu.firmware().filter().attitude().pitch()), -0.1, 0.03);
  EXPECT_LT(pitch, 0.0);
  EXPECT_GT(truth.v_NB_N.y(), 0.5) << "to the right";
  EXPECT_GT(truth.v_NB_N.x(), 0.2) << "forward";
}

/// A custom mixer in newtons for the reference vehicle, and the motor model of its motors.
VirtualFcuConfig physical_config(const simulator::VehicleParams& vehicle, double density) {
  std::vector<virtual_fcu::MixerRotor> rotors;
  for (const simulator::RotorMount& mount : vehicle.rotors) {
    rotors.push_back({mount.position.x(), mount.position.y(), -static_cast<double>(mount.direction)});
  }
  const virtual_fcu::MixerPropeller propeller = {.density = density,
                                                 .diameter = vehicle.rotor.diameter,
                                                 .CT = vehicle.rotor.CT[0],
                                                 .CQ = vehicle.rotor.CQ[0]};
  const auto mixer = virtual_fcu::physical_mixer(rotors, propeller);
  VirtualFcuConfig config = Flight::fcu_config();
  config.parameters[0].value = 11;
  const std::vector<virtual_fcu::ParameterOverride> motor = {
      {"USE_MOTOR_PARAM", 1},
      {"MOTOR_RESISTANCE", vehicle.rotor.resistance},
      {"MOTOR_KV", vehicle.rotor.K_V},
      {"NO_LOAD_CURRENT", vehicle.rotor.no_load_current},
      {"PROP_DIAMETER", vehicle.rotor.diameter},
      {"PROP_CT", vehicle.rotor.CT[0]},
      {"PROP_CQ", vehicle.rotor.CQ[0]},
      {"BATT_VOLT_MAX", 24.0}};
  config.parameters.insert(config.parameters.end(), motor.begin(), motor.end());
  for (std::size_t j = 0; j < rotors.size(); ++j) {
    config.parameters.push_back({"PRI_MIXER_OUT_" + std::to_string(j), 2});
    for (std::size_t i = 0; i < 10; ++i) {
      config.parameters.push_back({"PRI_MIXER_" + std::to_string(i) + "_" + std::to_string(j), mixer[i][j]});
    }
  }
  return config;
}

TEST(VirtualFcuTest, MakesTheThrustAndTorqueOfAPassThroughCommand) {
  const simulator::WorldConfig world = Flight::world_config();
  const double density = Flight().world.environment().air_density(50.0);
  Flight flight(physical_config(world.vehicle, density));
  flight.fcu.pilot().arm(true);
  flight.advance(8);
  flight.fcu.pilot().override_companion(false);
  const double thrust = 1.3 * world.vehicle.mass * 9.80665;
  flight.command = rosflight::OffboardControl{
      .u = {0, 0, static_cast<float>(-thrust), 0.08F, -0.04F, 0.06F}, .ignore = 0, .mode = 0};
  flight.advance(8);
  const simulator::Truth& truth = flight.world.truth();
  constexpr double kLiveDensity =
      0.02;  // the motor model's density comes from the barometer by another formula
  EXPECT_NEAR(truth.f_B.z() * world.vehicle.mass / -thrust, 1.0, kLiveDensity);
  EXPECT_NEAR(truth.w_dot_NB_B.x() * world.vehicle.inertia.Jxx / 0.08, 1.0, kLiveDensity);
  EXPECT_NEAR(truth.w_dot_NB_B.y() * world.vehicle.inertia.Jyy / -0.04, 1.0, kLiveDensity);
  EXPECT_NEAR(truth.w_dot_NB_B.z() * world.vehicle.inertia.Jzz / 0.06, 1.0, kLiveDensity);
}

TEST(VirtualFcuTest, RepeatsItselfToTheBit) {
  const auto fly = [] {
    Flight flight;
    flight.fcu.pilot().arm(true);
    flight.advance(8);
    flight.fcu.pilot().override_companion(false);
    flight.command = rosflight::OffboardControl{.u = {0, 0, 0.5F, 0.1F}, .ignore = 0, .mode = 2};
    flight.advance(400);
    return flight.world.truth().p_NB_N;
  };
  const simulator::Vector3 first = fly();
  const simulator::Vector3 second = fly();
  EXPECT_EQ(first.x(), second.x());
  EXPECT_EQ(first.y(), second.y());
  EXPECT_EQ(first.z(), second.z());
  EXPECT_NE(first.z(), -50.0);
}

}  // namespace
}  // namespace ironbird::hil_bridge
