#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/mission.hpp"
#include "hil_bridge/interlock/interlock.hpp"
#include "hil_bridge/transport/link_fault.hpp"
#include "scenarios/bench/fcu_config.hpp"
#include "scenarios/bench/link_faults.hpp"
#include "scenarios/requirements/check_config.hpp"
#include "simulator/environment/environment.hpp"
#include "simulator/fault/fault.hpp"
#include "simulator/sensors/sensor_suite.hpp"
#include "simulator/vehicle/vehicle.hpp"

namespace ironbird::scenarios {

/// Which physics engine integrates.
enum class Engine : std::uint8_t { kMujoco, kOde, kRigidBody };

constexpr std::array<std::pair<Engine, std::string_view>, 3> enumerators(Engine) {
  return {{{Engine::kMujoco, "mujoco"}, {Engine::kOde, "ode"}, {Engine::kRigidBody, "rigid_body"}}};
}

struct PlantConfig {
  Engine engine = Engine::kMujoco;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("engine", self.engine, "1", "mujoco, ode, or rigid_body (no contact)");
  }
};

/// The gate through which motor commands leave. docs/safety.md
struct InterlockChoice {
  hil_bridge::InterlockProfile profile = hil_bridge::InterlockProfile::kFlight;
  int greatest_missed = 20;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("profile", self.profile, "1", "what follows a kill: bench, zero thrust; flight, silence");
    visit("greatest_missed", self.greatest_missed, "1",
          "serial: so many control periods missed in a row kill; at most half of OFFBOARD_TIMEOUT", 1.0,
          200.0);
  }
};

/// Where the vehicle stands, or flies, at time zero.
struct StartConfig {
  std::array<double, 3> p_N{};
  double heading = 0.0;
  bool on_ground = true;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position from the local origin", -1e4, 1e4);
    visit("heading", self.heading, "rad", "heading", -6.283185307179586, 6.283185307179586);
    visit("on_ground", self.on_ground, "1", "settled on the ground; p_N's height is then the ground's");
  }
};

/// What the simulated pilot and operator do by themselves at the beginning of a run.
struct PilotConfig {
  /// s, after arming: the pilot gives the vehicle to the companion.
  static constexpr double kHandOverDelay = 0.5;
  /// s, after the vehicle has come to rest from a landing: the pilot disarms.
  static constexpr double kDisarmDelay = 1.0;

  bool automatic = true;
  double arm_at = 4.0;
  double take_off_at = 5.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("automatic", self.automatic, "1", "arm and take off at the times below; else only events do");
    visit("arm_at", self.arm_at, "s", "when the pilot arms", 0.0, 86400.0);
    visit("take_off_at", self.take_off_at, "s", "when the operator asks for take-off", 0.0, 86400.0);
  }
};

/// What the pilot's hands do at an event.
enum class PilotAction : std::uint8_t {
  kArm,
  kDisarm,
  kTakeOver,
  kHandOver,
  kMoveThrottle,  ///< the stick to `magnitude`, 0..1; the FCU may take it as the limit of the companion's
  kLoseRadio,
  kFindRadio
};

constexpr std::array<std::pair<PilotAction, std::string_view>, 7> enumerators(PilotAction) {
  return {{{PilotAction::kArm, "arm"},
           {PilotAction::kDisarm, "disarm"},
           {PilotAction::kTakeOver, "take_over"},
           {PilotAction::kHandOver, "hand_over"},
           {PilotAction::kMoveThrottle, "move_throttle"},
           {PilotAction::kLoseRadio, "lose_radio"},
           {PilotAction::kFindRadio, "find_radio"}}};
}

/// What the operator asks of the autopilot at an event.
enum class OperatorWish : std::uint8_t {
  kTakeOff,
  kLand,
  kResume,
  kHold,
  kRelease,
  kReturnToLaunch,
  kClearRoute,
  kListRoute,
  kFollowerFlies
};

constexpr std::array<std::pair<OperatorWish, std::string_view>, 9> enumerators(OperatorWish) {
  return {{{OperatorWish::kTakeOff, "take_off"},
           {OperatorWish::kLand, "land"},
           {OperatorWish::kResume, "resume"},
           {OperatorWish::kHold, "hold"},
           {OperatorWish::kRelease, "release"},
           {OperatorWish::kReturnToLaunch, "return_to_launch"},
           {OperatorWish::kClearRoute, "clear_route"},
           {OperatorWish::kListRoute, "list_route"},
           {OperatorWish::kFollowerFlies, "follower_flies"}}};
}

/// A setpoint at one of the controller's twelve entry points; exactly one is given.
struct SetpointConfig {
  std::optional<autopilot::PositionHeading> position_heading;
  std::optional<autopilot::VelocityHeightHeadingRate> velocity_height_heading_rate;
  std::optional<autopilot::AccelerationHeadingRate> acceleration_heading_rate;
  std::optional<autopilot::VelocityHeadingRate> velocity_heading_rate;
  std::optional<autopilot::PositionClimbHeading> position_climb_heading;
  std::optional<autopilot::AngleHeadingThrottle> angle_heading_throttle;
  std::optional<autopilot::AngleHeadingRateThrottle> angle_heading_rate_throttle;
  std::optional<autopilot::RateThrottle> rate_throttle;
  std::optional<autopilot::TorqueThrust> torque_thrust;
  std::optional<autopilot::AngleHeadingThrust> angle_heading_thrust;
  std::optional<autopilot::AngleHeadingRateThrust> angle_heading_rate_thrust;
  std::optional<autopilot::RateThrust> rate_thrust;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("position_heading", self.position_heading, "", "entry 0");
    visit("velocity_height_heading_rate", self.velocity_height_heading_rate, "", "entry 1");
    visit("acceleration_heading_rate", self.acceleration_heading_rate, "", "entry 2");
    visit("velocity_heading_rate", self.velocity_heading_rate, "", "entry 3");
    visit("position_climb_heading", self.position_climb_heading, "", "entry 4");
    visit("angle_heading_throttle", self.angle_heading_throttle, "", "entry 5");
    visit("angle_heading_rate_throttle", self.angle_heading_rate_throttle, "", "entry 6");
    visit("rate_throttle", self.rate_throttle, "", "entry 7");
    visit("torque_thrust", self.torque_thrust, "", "entry 8");
    visit("angle_heading_thrust", self.angle_heading_thrust, "", "entry 9");
    visit("angle_heading_rate_thrust", self.angle_heading_rate_thrust, "", "entry 10");
    visit("rate_thrust", self.rate_thrust, "", "entry 11");
  }
};

/// Something that happens during a run, at a time or some time after another event. Exactly one thing
/// happens.
struct EventConfig {
  std::string name;
  double at = 0.0;
  std::string after;
  bool optional = false;
  std::optional<simulator::FaultKind> fault;
  std::optional<LinkFaultKind> link;
  std::optional<LinkFaultKind> bus;
  double lasts = 0.0;
  std::optional<int> index;
  double magnitude = 0.0;
  std::array<double, 3> vector{};
  std::optional<PilotAction> pilot;
  std::optional<OperatorWish> request;
  std::optional<autopilot::Waypoint> add_waypoint;
  std::optional<int> remove_waypoint;
  std::optional<SetpointConfig> setpoint;
  std::string swap;
  std::string kind;
  std::string set;
  double value = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "for the log and the checks; by default what happens");
    visit("at", self.at, "s", "when: since the start of the run, or since the event in `after`", 0.0,
          86400.0);
    visit("after", self.after, "",
          "the event that `at` counts from, for example \"offboard\" or \"waypoint_1\"");
    visit("optional", self.optional, "1",
          "it need not come; without it a run that it does not come in shows nothing");
    visit("fault", self.fault, "1", "a fault begins");
    visit("link", self.link, "1", "the line to the flight-control unit goes wrong, both ways");
    visit("bus", self.bus, "1", "the bus of the motors goes wrong, both ways");
    visit("lasts", self.lasts, "s", "how long the fault lasts; 0: to the end", 0.0, 86400.0);
    visit("index", self.index, "1", "of the rotor or waypoint that is meant, from 0", 0.0, 1000.0);
    visit("magnitude", self.magnitude, "SI",
          "of the fault, in its unit; of a hold, s; of the throttle stick, 0..1", -1e9, 1e9);
    visit("vector", self.vector, "SI", "of the fault, in its unit", -1e6, 1e6);
    visit("pilot", self.pilot, "1", "the pilot's hands");
    visit("request", self.request, "1", "a request of the operator");
    visit("add_waypoint", self.add_waypoint, "",
          "a waypoint is added at the end, or before the one with number `index`, from 0");
    visit("remove_waypoint", self.remove_waypoint, "1", "the waypoint with this index is removed", 0.0,
          1000.0);
    visit("setpoint", self.setpoint, "", "the controller flies this setpoint instead of the follower's");
    visit("swap", self.swap, "", "the module in this slot is replaced by one of `kind`");
    visit("kind", self.kind, "", "kind of the new module");
    visit("set", self.set, "", "path of a parameter of the autopilot that is set to `value`");
    visit("value", self.value, "SI", "its new value, in the parameter's unit; 0 or 1 for false or true");
  }
};

/// A fixed camera.
struct CameraConfig {
  std::string name;
  std::array<double, 3> p_N{};
  std::array<double, 3> target_N{};
  double field_of_view = 0.9;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "for snapshots and cuts");
    visit("p_N", self.p_N, "m", "where it stands", -1e5, 1e5);
    visit("target_N", self.target_N, "m", "what it looks at", -1e5, 1e5);
    visit("field_of_view", self.field_of_view, "rad", "vertical angle of view", 0.05, 2.5);
  }
};

/// A picture to take.
struct SnapshotConfig {
  std::string name;
  double at = 0.0;
  std::string after;
  std::string camera = "chase";

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "of the file");
    visit("at", self.at, "s", "when: since the start of the run, or since the event in `after`", 0.0,
          86400.0);
    visit("after", self.after, "", "the event that `at` counts from");
    visit("camera", self.camera, "", "chase, top, or the name of a camera of the scenario");
  }
};

/// When the film cuts to another camera.
struct CutConfig {
  double at = 0.0;
  std::string camera = "chase";

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("at", self.at, "s", "when", 0.0, 86400.0);
    visit("camera", self.camera, "", "chase, top, or the name of a camera of the scenario");
  }
};

/// What the log holds and how often.
struct RecordConfig {
  double state_period = 0.01;
  double signal_period = 0.02;
  bool frames = true;
  bool journal = false;
  bool compress = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("state_period", self.state_period, "s", "of truth and estimate", 0.0025, 10.0);
    visit("signal_period", self.signal_period, "s", "of trajectory, setpoint, command and telemetry", 0.0025,
          10.0);
    visit("frames", self.frames, "1", "every sensor frame and every command, which an exact replay needs");
    visit("journal", self.journal, "1", "write message by message, so that a crash costs 0.1 s of the log");
    visit("compress", self.compress, "1", "compress the log with zstd; not with journal");
  }
};

/// What a whole number in a scenario file can hold.
inline constexpr std::uint64_t kGreatestSeed = std::numeric_limits<std::int64_t>::max();

/// Everything that a scenario file says, the vehicle's own files included.
struct Scenario {
  std::string title;
  std::string source;
  std::string vehicle_folder = "models/x650";
  std::string field = "models/fields/flat.xml";
  std::uint64_t seed = 1;
  double duration = 60.0;
  std::string end_after;
  double end_delay = 0.0;
  bool cyclic = false;
  PlantConfig plant;
  StartConfig start;
  PilotConfig pilot;
  simulator::VehicleParams vehicle;
  simulator::EnvironmentParams environment;
  simulator::SensorSuiteParams sensors;
  FcuConfig fcu;
  InterlockChoice interlock;
  hil_bridge::transport::LinkFaultConfig link;
  std::vector<autopilot::Waypoint> waypoints;
  std::vector<EventConfig> events;
  std::vector<CheckConfig> checks;
  std::vector<CameraConfig> cameras;
  std::vector<CutConfig> cuts;
  std::vector<SnapshotConfig> snapshots;
  RecordConfig record;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("title", self.title, "", "what the scenario shows");
    visit("source", self.source, "", "where it comes from");
    visit("vehicle", self.vehicle_folder, "",
          "folder with vehicle.toml, sensors.toml, fcu.toml, autopilot.toml");
    visit("field", self.field, "", "picture of the place");
    visit("seed", self.seed, "1", "of every random stream", 0.0);
    visit("duration", self.duration, "s", "when the run ends at the latest", 0.1, 86400.0);
    visit("end_after", self.end_after, "", "the event that ends the run earlier");
    visit("end_delay", self.end_delay, "s", "how long after it", 0.0, 86400.0);
    visit("cyclic", self.cyclic, "1", "after the last waypoint comes the first");
    visit("plant", self.plant, "", "physics engine");
    visit("start", self.start, "", "where the vehicle stands at time zero");
    visit("pilot", self.pilot, "", "what pilot and operator do by themselves");
    visit("environment", self.environment, "", "air, wind, gravity, magnetic field");
    visit("sensors", self.sensors, "", "the vehicle's sensors");
    visit("fcu", self.fcu, "", "the flight-control unit");
    visit("interlock", self.interlock, "", "the gate through which motor commands leave");
    visit("link", self.link, "", "what goes wrong with the line of a unit that is served");
    visit("waypoint", self.waypoints, "", "the mission, one table each");
    visit("event", self.events, "", "what happens, one table each");
    visit("check", self.checks, "", "what must hold, one table each");
    visit("camera", self.cameras, "", "fixed cameras, one table each");
    visit("cut", self.cuts, "", "when the film changes cameras, one table each");
    visit("snapshot", self.snapshots, "", "pictures to take, one table each");
    visit("record", self.record, "", "what the log holds");
  }
};

}  // namespace ironbird::scenarios
