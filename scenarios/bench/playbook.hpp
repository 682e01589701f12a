#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/bench/scenario.hpp"
#include "scenarios/bench/script.hpp"
#include "scenarios/requirements/timeline.hpp"

namespace ironbird::scenarios {

/// What an item of a scenario's script stands for.
struct Deed {
  enum class Kind { kEvent, kFaultEnd, kLinkFaultEnd, kArm, kHandOver, kTakeOff, kDisarm, kSnapshot, kEnd };
  Kind kind = Kind::kEvent;
  std::size_t index = 0;  // into the scenario's events or snapshots, or the number of a fault
};

/// Knows what a scenario wants done when: its events, its pictures, its end, and what is added while it runs.
class Playbook {
 public:
  using Time = Script::Time;

  /// @param scenario  outlives this
  explicit Playbook(const Scenario& scenario) : scenario_(scenario) {}

  /// Adds the scenario's own: its events, pictures and end.
  void add_scenario();
  /// @param after  the event that `delay`, s, counts from; empty: the start
  void add(const std::string& after, double delay, Deed deed);
  void add_at(Time when, Deed deed);

  /// The next deed that is due at `now` and was not given out before, or nothing.
  std::optional<Deed> next_due(Time now);

  /// Something happened, and what waits for it gets its time.
  void hear(const RunEvent& event, Time now);

  /// What the scenario says and did not happen, so that its checks show nothing, one line each.
  /// @param events  all of the run
  std::vector<std::string> gaps(const std::vector<RunEvent>& events) const;
  /// What else was never done, and what was refused, one line each.
  std::vector<std::string> warnings(const std::vector<RunEvent>& events) const;

 private:
  std::string name_of(const Deed& deed) const;

  const Scenario& scenario_;
  Script script_;
  std::vector<Deed> deeds_;
};

}  // namespace ironbird::scenarios
