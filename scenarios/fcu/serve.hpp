#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hil_bridge/transport/byte_stream.hpp"
#include "hil_bridge/transport/frame_bus.hpp"
#include "hil_bridge/virtual_fcu/can_outputs.hpp"
#include "hil_bridge/virtual_fcu/served_fcu.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"
#include "scenarios/bench/ground_watch.hpp"
#include "scenarios/bench/scenario.hpp"
#include "simulator/world.hpp"

namespace ironbird::scenarios {

/// A virtual unit with its own vehicle and world, for somebody at the other end of a line. Its pilot waits
/// for that somebody to be there: the clock of the scenario's `[pilot]` begins with the first frame that
/// comes.
class ServedUnit {
 public:
  /// @param line  outlives this
  /// @param bus   on which its motors are, beside OUTPUT_RAW; null: none; outlives this
  /// @throws std::invalid_argument naming key, value and bound
  ServedUnit(const Scenario& scenario, hil_bridge::transport::ByteStream& line,
             hil_bridge::transport::FrameBus* bus = nullptr);

  /// Lets one tick pass: takes what came, steps world and firmware, gives what is said.
  void tick();

  hil_bridge::Time now() const { return now_; }
  hil_bridge::Time period() const { return scenario_.fcu.tick; }
  const simulator::World& world() const { return *world_; }
  const hil_bridge::VirtualFcu& unit() const { return fcu_; }
  const hil_bridge::ServedFcu& served() const { return served_; }

 private:
  void act_as_pilot();

  Scenario scenario_;
  std::unique_ptr<simulator::World> world_;
  hil_bridge::VirtualFcu fcu_;
  hil_bridge::ServedFcu served_;
  std::optional<hil_bridge::CanOutputs> motors_;
  GroundWatch ground_;
  hil_bridge::Time now_{};
  std::optional<hil_bridge::Time> since_;  // somebody is there
  std::optional<hil_bridge::Time> down_;   // landed
  bool armed_ = false;
  bool handed_over_ = false;
};

}  // namespace ironbird::scenarios
