#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "simulator/environment/environment.hpp"
#include "simulator/fault/fault.hpp"
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
  Vector3 initial_p_NB_N =
      Vector3::Zero();           ///< m; height is corrected so that the vehicle rests when `on_ground`
  double initial_heading = 0.0;  ///< rad
  bool on_ground = true;         ///< settle on the ground before time zero
  std::uint64_t seed = 1;
};

/// One vehicle in one environment: steps the plant, samples the sensors, applies faults.
class World {
 public:
  /// @throws std::invalid_argument for parameters that make no sense; the message names the parameter, its
  /// value and its bound
  World(const WorldConfig& config, std::unique_ptr<Plant> plant);
  ~World();

  /// Advances to `until` with the commands held, then samples the sensors due at `until`.
  /// @param until  later than the time reached so far
  void step(const RotorCommands& commands, Time until);

  /// Begins a fault. @return a number to end it by
  int begin(const Fault& fault);
  /// Ends the fault that `begin` returned `id` for.
  void end(int id);

  /// The state at the time reached.
  const Truth& truth() const { return truth_; }

  /// What the sensors delivered in the last step.
  const Readings& readings() const { return readings_; }

  /// Why the simulation can no longer be believed, or null.
  const char* failure() const { return plant_->failure(); }

  const Environment& environment() const { return environment_; }
  const Vehicle& vehicle() const { return vehicle_; }

 private:
  struct ActiveFault {
    int id = 0;
    Fault fault;
  };

  Vehicle vehicle_;
  Environment environment_;
  SensorSuite sensors_;
  std::unique_ptr<Plant> plant_;
  std::vector<ActiveFault> faults_;
  int next_fault_ = 1;
  Truth truth_;
  Readings readings_;
};

}  // namespace ironbird::simulator
