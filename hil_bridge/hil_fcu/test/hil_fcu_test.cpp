#include "hil_bridge/hil_fcu/hil_fcu.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <memory>

#include "hil_bridge/hil_fcu/test/puppet.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"
#include "hil_bridge/virtual_fcu/can_outputs.hpp"
#include "simulator/plant/rigid_body_plant.hpp"

namespace ironbird::hil_bridge {
namespace {

using test::kTick;
using test::Puppet;

simulator::WorldConfig world_config() {
  simulator::WorldConfig config;
  config.vehicle = simulator::reference_multirotor();
  config.initial_p_NB_N = {0.0, 0.0, -50.0};
  config.on_ground = false;
  return config;
}

class Desk {
 public:
  explicit Desk(double external_attitude = 0.0)
      : world(world_config(), std::make_unique<simulator::RigidBodyPlant>()),
        fcu({}, world, unit, nullptr, external_attitude) {}

  void run(int ticks) {
    for (int k = 0; k < ticks; ++k) {
      now += kTick;
      fcu.advance(now);
      std::vector<Arrival> arrivals;
      fcu.receive(arrivals);
      for (const Arrival& arrival : arrivals) ++heard[arrival.message.index()];
      last.insert(last.end(), arrivals.begin(), arrivals.end());
    }
  }
  template <class M>
  int count() const {
    const auto found = heard.find(rosflight::Message(M{}).index());
    return found == heard.end() ? 0 : found->second;
  }

  simulator::World world;
  Puppet unit;
  HilFcu fcu;
  Time now{};
  std::map<std::size_t, int> heard;
  std::vector<Arrival> last;
};

TEST(HilFcuTest, TellsTheSimulatedSensorsAtTheRatesOfAUnit) {
  Desk desk;
  desk.run(400);
  EXPECT_EQ(desk.count<rosflight::SmallImu>(), 400);
  EXPECT_GT(desk.count<rosflight::SmallMag>(), 40);
  EXPECT_GT(desk.count<rosflight::SmallBaro>(), 40);
  EXPECT_GT(desk.count<rosflight::RosflightGnss>(), 4);
  // Of a unit that says nothing nothing is known.
  EXPECT_EQ(desk.count<rosflight::RosflightStatus>(), 0);
  EXPECT_EQ(desk.count<rosflight::Heartbeat>(), 0);
  EXPECT_EQ(desk.count<rosflight::RosflightOutputRaw>(), 0);
  EXPECT_EQ(desk.count<rosflight::RosflightBatteryStatus>(), 0);
}

TEST(HilFcuTest, PassesOnWhatTheUnitSaysExceptOfItsOwnSensors) {
  Desk desk;
  desk.run(1);
  desk.heard.clear();
  desk.unit.says = {rosflight::SmallImu{.xacc = 77.0F},
                    rosflight::SmallMag{},
                    rosflight::SmallBaro{},
                    rosflight::RosflightGnss{},
                    rosflight::SmallRange{},
                    rosflight::DiffPressure{},
                    rosflight::RosflightStatus{},
                    rosflight::RcChannels{},
                    rosflight::ParamValue{},
                    rosflight::RosflightVersion{},
                    rosflight::RosflightBatteryStatus{},
                    rosflight::AttitudeQuaternion{},
                    rosflight::Statustext{},
                    rosflight::RosflightOutputRaw{}};
  desk.last.clear();
  desk.run(1);
  for (const Arrival& arrival : desk.last) {
    const auto* imu = std::get_if<rosflight::SmallImu>(&arrival.message);
    EXPECT_TRUE(imu == nullptr || imu->xacc != 77.0F);
  }
  EXPECT_EQ(desk.count<rosflight::SmallImu>(), 1);
  EXPECT_EQ(desk.count<rosflight::SmallRange>(), 0);
  EXPECT_EQ(desk.count<rosflight::RosflightStatus>(), 1);
  EXPECT_EQ(desk.count<rosflight::RcChannels>(), 1);
  EXPECT_EQ(desk.count<rosflight::ParamValue>(), 1);
  EXPECT_EQ(desk.count<rosflight::RosflightVersion>(), 1);
  EXPECT_EQ(desk.count<rosflight::RosflightBatteryStatus>(), 1);
  EXPECT_EQ(desk.count<rosflight::AttitudeQuaternion>(), 1);
  EXPECT_EQ(desk.count<rosflight::Statustext>(), 1);
  EXPECT_EQ(desk.count<rosflight::RosflightOutputRaw>(), 1);
}

TEST(HilFcuTest, TurnsTheRotorsByTheOutputsThatTheUnitTellsUntilItFallsSilent) {
  Desk desk;
  rosflight::RosflightOutputRaw outputs;
  outputs.values = {0.1F, 0.2F, 1.5F, std::numeric_limits<float>::quiet_NaN()};
  desk.unit.says = {outputs};
  desk.run(2);
  EXPECT_FLOAT_EQ(static_cast<float>(desk.fcu.commands().throttle[1]), 0.2F);
  EXPECT_EQ(desk.fcu.commands().throttle[2], 1.0);
  EXPECT_EQ(desk.fcu.commands().throttle[3], 0.0);
  desk.run(200);  // half a second
  EXPECT_GT(desk.fcu.commands().throttle[1], 0.0);
  desk.run(1);
  EXPECT_EQ(desk.fcu.commands().throttle[1], 0.0);
}

TEST(HilFcuTest, HandsTheUnitTheSimulatedAttitudeAtItsRateAndOnlyWhenAsked) {
  Desk silent;
  silent.run(400);
  EXPECT_TRUE(silent.unit.told.empty());
  Desk desk(100.0);
  desk.run(400);
  EXPECT_EQ(desk.unit.told.size(), 100U);
  const auto& said = std::get<rosflight::ExternalAttitude>(desk.unit.told.back());
  EXPECT_NEAR(said.qw, desk.world.truth().q_NB.w(), 1e-3);
}

TEST(HilFcuTest, SendsTheUnitWhatTheCompanionSends) {
  Desk desk;
  desk.fcu.send(rosflight::OffboardControl{.u = {1.0F}});
  ASSERT_EQ(desk.unit.told.size(), 1U);
  EXPECT_EQ(std::get<rosflight::OffboardControl>(desk.unit.told[0]).u[0], 1.0F);
}

TEST(HilFcuTest, TurnsTheRotorsOverABusAsFastAsTheUnitDecides) {
  VirtualFcuConfig config;
  config.calibrate_imu_at_start = false;
  config.on_desk = true;
  config.parameters = {{"PRIMARY_MIXER", 2}, {"FAILSAFE_THR", 0.3}, {"GYRO_X_BIAS", 1e-9}, {"RC_NUM_CHN", 8},
                       {"RC_ARM_CHN", 4},    {"TAKE_MIN_THR", 1},   {"FILT_INIT_T", 0}};
  simulator::World desk_world(world_config(), std::make_unique<simulator::RigidBodyPlant>());
  VirtualFcu unit(config, desk_world);
  transport::InProcessBus bus;
  CanOutputs outputs(4, bus.attach(), Time{0});
  CanMotors motors({}, world_config().vehicle.rotor, bus.attach(), Time{0});
  simulator::World world(world_config(), std::make_unique<simulator::RigidBodyPlant>());
  HilFcu fcu(config, world, unit, &motors);
  unit.pilot().arm(true);
  for (Time now = kTick; now < std::chrono::seconds(2); now += kTick) {
    fcu.advance(now);
    outputs.step(unit, now);
    bus.advance(now + kTick);
    if (now < std::chrono::seconds(1)) continue;
    fcu.advance(now + kTick);
    now += kTick;
    // What the unit decided in the last tick is what the rotors do in this one.
    for (std::size_t k = 0; k < 4; ++k) {
      ASSERT_GT(fcu.commands().throttle[k], 0.05);
      ASSERT_NEAR(fcu.commands().throttle[k], unit.commands().throttle[k], 2.0 / 8191.0);
    }
    outputs.step(unit, now);
    bus.advance(now + kTick);
  }
  EXPECT_TRUE(unit.firmware().arming().armed());
  // The desk feels nothing of it: its own rotors stand still.
  EXPECT_GT(world.truth().rotor_speed[0], 2.0 * desk_world.truth().rotor_speed[0]);
}

}  // namespace
}  // namespace ironbird::hil_bridge
