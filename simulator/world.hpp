#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "simulator/environment/environment.hpp"
#include "simulator/fault/fault.hpp"
#include "simulator/fault/fault_state.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/sensors/sensor_suite.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/rotor_commands.hpp"
#include "simulator/types/time.hpp"
#include "simulator/types/truth.hpp"
#include "simulator/vehicle/vehicle.hpp"

namespace ironbird::simulator {

/// Everything that a world is made of, all of it data.
struct WorldConfig {
  VehicleParams vehicle;
  EnvironmentParams environment;
  SensorSuiteParams sensors;
  Vector3 initial_p_NB_N = Vector3::Zero();
  double initial_heading = 0.0;
  bool on_ground = true;
  Time tick = std::chrono::microseconds(2500);
  std::uint64_t seed = 1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("vehicle", self.vehicle, "", "the vehicle");
    visit("environment", self.environment, "", "air, ground, field");
    visit("sensors", self.sensors, "", "what it carries");
    visit("initial_p_NB_N", self.initial_p_NB_N, "m",
          "where it starts; the height is corrected so that it rests when `on_ground`");
    visit("initial_heading", self.initial_heading, "rad", "its heading there");
    visit("on_ground", self.on_ground, "1",
          "settle on the ground before time zero; otherwise hover in the air");
    visit("tick", self.tick, "ns", "step of the plant and of the sensors");
    visit("seed", self.seed, "1", "of every noise in the world");
  }
};

/// One vehicle in one environment: steps the plant, samples the sensors, applies faults.
///
/// In every tick: environment, plant, truth, sensors, in this order. Near the ground and obstacles the plant
/// takes several equal steps per tick, as many as its contact asks for; the rest of the world does not
/// notice.
class World {
 public:
  /// Puts the vehicle on the ground and lets it come to rest, which takes no time of the run; with a plant
  /// without ground it starts where it stands, at rest.
  /// @throws std::invalid_argument for parameters that make no sense; the message names the parameter, its
  /// value and its bound
  World(const WorldConfig& config, std::unique_ptr<Plant> plant);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Advances to `until` with the commands held; `readings()` is then what arrived on the way, the last one
  /// of each sensor.
  /// @param until  later than the time reached so far, by a whole number of ticks
  void step(const RotorCommands& commands, Time until);

  /// Begins a fault. A battery fault acts once, here. @return a number to end it by
  /// @throws std::invalid_argument for a fault that this vehicle cannot have, see `check`
  int begin(const Fault& fault);
  /// Ends the fault that `begin` returned `id` for; without one does nothing.
  void end(int id);

  /// Tells the sensors whether the FCU lets the motors turn.
  void set_armed(bool armed) { sensors_.set_armed(armed); }

  /// The state at the time reached.
  const Truth& truth() const { return truth_; }

  /// What the sensors delivered in the last step.
  const Readings& readings() const { return readings_; }

  /// The sum of the faults that act now.
  const FaultState& faults() const { return fault_state_; }

  /// Why the simulation can no longer be believed, or null.
  const char* failure() const { return plant_->failure(); }

  const Environment& environment() const { return environment_; }
  const Vehicle& vehicle() const { return vehicle_; }

 private:
  struct ActiveFault {
    int id = 0;
    Fault fault;
  };

  void settle(const RigidBodyState& start);
  void advance_tick();
  void step_plant();
  std::int64_t plant_steps() const;
  void apply_faults();
  void update_truth(const RigidBodyState& before);
  void copy_state_to_truth();

  Time tick_;
  Environment environment_;
  Vehicle vehicle_;
  SensorSuite sensors_;
  std::unique_ptr<Plant> plant_;
  std::vector<ActiveFault> faults_;
  FaultState fault_state_;
  int next_fault_ = 1;
  Truth truth_;
  Readings readings_;
};

}  // namespace ironbird::simulator
