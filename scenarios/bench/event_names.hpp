#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/bench/scenario.hpp"

namespace ironbird::scenarios {

/// The most waypoints that the mission of this scenario can have: its own and those that events add.
std::size_t longest_mission(const Scenario& scenario);

/// The most waypoints that can be reached in a run of this scenario, whose route is not cyclic: the mission
/// in every flight, and each return to launch.
std::size_t reachable_waypoints(const Scenario& scenario);

/// The most waypoints that the route of a run of this scenario can have at once.
std::size_t longest_route(const Scenario& scenario);

/// What a run says when a motor controller on the stand begins to report, or falls silent.
std::string stand_event(std::size_t motor, bool ready);

/// Every name by which an event of a run of this scenario can be called, known before it is flown.
///
/// Beside the scenario's own events these are phases, arming, health, ground contact and waypoints. What the
/// FCU says is not known in advance: `fcu:` with any text behind it counts as known, and is told from a wrong
/// one by nobody.
class EventNames {
 public:
  /// Who waits: a deed of the scenario waits for a text or `kind:text`, a check may wait for a kind too.
  enum class Waiting : std::uint8_t { kDeed, kCheck };

  explicit EventNames(const Scenario& scenario);

  /// Why an event of this name cannot happen, with the nearest name that can; empty when it can.
  std::string complaint(const std::string& name, Waiting waiting) const;

  /// Why the scenario cannot call an event of its own so: who waits for it would be served by another, or by
  /// none. Empty when it can.
  std::string objection(const std::string& name) const;

 private:
  struct Name {
    std::string kind;
    std::string text;
  };

  void add_flight(const Scenario& scenario);
  void add_bus(const std::string& kind);
  void add_stand(const Scenario& scenario);
  void add_waypoints(const Scenario& scenario);
  void add_own(const Scenario& scenario);
  void add_deed(const EventConfig& event);
  bool is_waypoint(std::string_view name) const;
  bool known(const std::string& name, Waiting waiting) const;
  std::vector<std::string> spoken(Waiting waiting) const;

  std::vector<Name> names_;
  std::size_t of_the_run_ = 0;            ///< how many of these, in front, are not the scenario's own
  std::vector<std::string> in_circles_;   ///< of events that wait, in the end, for themselves
  std::optional<std::size_t> waypoints_;  ///< that can be reached; nothing: a cyclic route goes on for ever
};

}  // namespace ironbird::scenarios
