// Whatever a stream from the FCU does, what reaches a motor is a number between 0 and 1, and what flies on is
// upright: every stream, with gaps and with absurd values, in every phase of a flight.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/lockstep.hpp"
#include "hil_bridge/executive/test/live_guard.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "simulator/plant/mujoco_plant.hpp"
#include "simulator/world.hpp"

namespace ironbird::scenarios {
namespace {

using autopilot::FlightPhase;
using hil_bridge::Arrival;
using hil_bridge::Time;
namespace wire = hil_bridge::rosflight;

constexpr double kUpright = 0.6;  // rad, the greatest tilt that the follower may ask for

enum class Stream { kImu, kMag, kBaro, kGnss, kStatus, kBattery };

/// One way to go wrong.
struct Spoil {
  Stream stream = Stream::kImu;
  bool silent = false;  ///< nothing arrives
  float value = 0.0F;   ///< otherwise: every number of the message
  double lasts = 0.0;   ///< s
};

/// Sets every floating-point member of a message.
struct Overwrite {
  float value;
  template <class Value, class... Rest>
  void operator()(const char*, Value& member, Rest&&...) const {
    if constexpr (std::is_floating_point_v<Value>) member = static_cast<Value>(value);
  }
};

/// An FCU whose messages are spoiled on their way to the companion.
class SpoiledFcu final : public hil_bridge::Fcu {
 public:
  explicit SpoiledFcu(hil_bridge::VirtualFcu& inner) : inner_(inner) {}

  void advance(Time now) override { inner_.advance(now); }
  void receive(std::vector<Arrival>& out) override {
    fresh_.clear();
    inner_.receive(fresh_);
    for (Arrival& arrival : fresh_) {
      if (spoil != nullptr && is_meant(arrival.message)) {
        if (spoil->silent) continue;
        std::visit([&](auto& message) { message.describe(message, Overwrite{spoil->value}); },
                   arrival.message);
      }
      out.push_back(arrival);
    }
  }
  void send(const wire::Message& message) override {
    if (const auto* control = std::get_if<wire::OffboardControl>(&message)) {
      for (const float u : control->u) sound = sound && std::fabs(u) < 1e3F;
    }
    inner_.send(message);
  }

  const Spoil* spoil = nullptr;
  bool sound = true;  ///< every number that was sent is one, and not absurd

 private:
  bool is_meant(const wire::Message& message) const {
    switch (spoil->stream) {
      case Stream::kImu:
        return std::holds_alternative<wire::SmallImu>(message);
      case Stream::kMag:
        return std::holds_alternative<wire::SmallMag>(message);
      case Stream::kBaro:
        return std::holds_alternative<wire::SmallBaro>(message);
      case Stream::kGnss:
        return std::holds_alternative<wire::RosflightGnss>(message);
      case Stream::kStatus:
        return std::holds_alternative<wire::RosflightStatus>(message);
      case Stream::kBattery:
        return std::holds_alternative<wire::RosflightBatteryStatus>(message);
    }
    return false;
  }

  hil_bridge::VirtualFcu& inner_;
  std::vector<Arrival> fresh_;
};

simulator::WorldConfig world_config(const Scenario& scenario) {
  simulator::WorldConfig config;
  config.vehicle = scenario.vehicle;
  config.environment = scenario.environment;
  config.sensors = scenario.sensors;
  config.tick = scenario.fcu.tick;
  config.seed = 3;
  return config;
}

/// A flight of the X650 up to a phase, then on with a spoiled stream.
class Flight {
 public:
  explicit Flight(const LoadedScenario& loaded, const autopilot::Modules& modules)
      : world(world_config(loaded.scenario), simulator::make_mujoco_plant(loaded.scenario.vehicle, {})),
        fcu(loaded.scenario.fcu, world),
        spoiled(fcu),
        pilot(loaded.autopilot, modules),
        lockstep(spoiled, pilot, live.guard, loaded.scenario.fcu.tick) {
    const autopilot::AutopilotConfig& kinds = loaded.autopilot;
    for (const auto& [slot, kind] : {std::pair{"estimator", kinds.estimator.kind},
                                     {"path_manager", kinds.path_manager.kind},
                                     {"trajectory_follower", kinds.trajectory_follower.kind},
                                     {"controller", kinds.controller.kind}}) {
      for (const auto& [path, value] : loaded.settings_of(slot, kind)->values) {
        pilot.parameters().set(path, value);
      }
    }
    autopilot::Waypoint there;
    there.p_N << 20.0, 0.0, -4.0;
    pilot.request(autopilot::RouteRequest(autopilot::SetRoute{{there}, false}));
  }

  FlightPhase phase() const { return pilot.controller().phase(); }

  void fly(double seconds) {
    const Time end = lockstep.now() + Time{std::llround(seconds * 1e9)};
    while (lockstep.now() < end) tick();
  }

  void tick() {
    const double before = autopilot::seconds(lockstep.now());
    lockstep.tick();
    const double now = autopilot::seconds(lockstep.now());
    const auto passes = [&](double at) { return before < at && now >= at; };
    if (passes(4.0)) fcu.pilot().arm(true);
    if (passes(4.5)) fcu.pilot().override_companion(false);
    if (passes(5.0)) pilot.request(autopilot::TakeOff{});
    for (const double throttle : fcu.commands().throttle) {
      motors_sound = motors_sound && throttle >= 0.0 && throttle <= 1.0;
    }
    const auto& q = world.truth().q_NB;
    const double upright = 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y());
    greatest_tilt = std::max(greatest_tilt, std::acos(std::clamp(upright, -1.0, 1.0)));
  }

  bool fly_to(FlightPhase wanted) {
    for (int i = 0; i < 12000 && phase() != wanted; ++i) tick();
    return phase() == wanted;
  }

  simulator::World world;
  hil_bridge::VirtualFcu fcu;
  SpoiledFcu spoiled;
  autopilot::Autopilot pilot;
  hil_bridge::test::LiveGuard live;  // what the gate would stop is not the question here
  hil_bridge::Lockstep lockstep;
  bool motors_sound = true;
  double greatest_tilt = 0.0;  // rad
};

/// When the stream breaks.
enum class Moment { kGround, kTakeOff, kOffboard, kLanding };

struct Case {
  std::string name;
  Moment moment;
  Spoil spoil;
};

std::vector<Case> all_cases() {
  const std::pair<const char*, Moment> moments[] = {{"OnTheGround", Moment::kGround},
                                                    {"InTheClimb", Moment::kTakeOff},
                                                    {"Offboard", Moment::kOffboard},
                                                    {"InTheLanding", Moment::kLanding}};
  const std::pair<const char*, Stream> streams[] = {
      {"Imu", Stream::kImu},   {"Mag", Stream::kMag},       {"Baro", Stream::kBaro},
      {"Gnss", Stream::kGnss}, {"Status", Stream::kStatus}, {"Battery", Stream::kBattery}};
  const std::pair<const char*, double> gaps[] = {{"50ms", 0.05}, {"500ms", 0.5}, {"5s", 5.0}, {"60s", 60.0}};
  const std::pair<const char*, float> values[] = {{"NaN", std::numeric_limits<float>::quiet_NaN()},
                                                  {"Infinity", std::numeric_limits<float>::infinity()},
                                                  {"Huge", 1e30F}};
  std::vector<Case> cases;
  for (const auto& [when, moment] : moments) {
    for (const auto& [which, stream] : streams) {
      const std::string name = std::string(which) + when;
      for (const auto& [how, lasts] : gaps)
        cases.push_back({name + "Gap" + how, moment, {stream, true, 0.0F, lasts}});
      if (stream == Stream::kStatus) continue;  // carries no such number
      for (const auto& [how, value] : values)
        cases.push_back({name + how, moment, {stream, false, value, 3.0}});
    }
  }
  return cases;
}

class BrokenStreamTest : public ::testing::TestWithParam<Case> {
 protected:
  static const LoadedScenario& loaded() {
    static const LoadedScenario scenario = load_scenario(
        std::filesystem::path(IRONBIRD_SOURCE_DIR) / "scenarios/library/missions/take_off_and_land.toml", {},
        autopilot::standard_modules());
    return scenario;
  }

  static void fly_to(Moment moment, Flight& flight) {
    flight.fly(3.0);
    if (moment == Moment::kGround) return;
    ASSERT_TRUE(flight.fly_to(FlightPhase::kTakeOff));
    flight.fly(1.5);
    if (moment == Moment::kTakeOff) return;
    ASSERT_TRUE(flight.fly_to(FlightPhase::kOffboard));
    flight.fly(3.0);
    if (moment == Moment::kOffboard) return;
    ASSERT_TRUE(flight.pilot.request(autopilot::Land{}).accepted);
    flight.fly(0.5);
  }
};

TEST_P(BrokenStreamTest, NeverReachesAMotor) {
  const autopilot::Modules modules = autopilot::standard_modules();
  Flight flight(loaded(), modules);
  ASSERT_NO_FATAL_FAILURE(fly_to(GetParam().moment, flight));
  flight.spoiled.spoil = &GetParam().spoil;
  flight.fly(GetParam().spoil.lasts);
  flight.spoiled.spoil = nullptr;
  flight.fly(8.0);
  EXPECT_TRUE(flight.spoiled.sound) << "what the companion sent";
  EXPECT_TRUE(flight.motors_sound) << "what the motors were told";
  // Without the IMU the companion has nothing to answer, and the pilot's idle stick flies.
  const bool companion_mute = GetParam().spoil.stream == Stream::kImu && GetParam().spoil.lasts > 0.1;
  if (companion_mute) return;
  EXPECT_LT(flight.greatest_tilt, kUpright) << "rad";
}

INSTANTIATE_TEST_SUITE_P(All, BrokenStreamTest, ::testing::ValuesIn(all_cases()),
                         [](const auto& case_) { return case_.param.name; });

}  // namespace
}  // namespace ironbird::scenarios
