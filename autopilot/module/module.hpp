#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "autopilot/module/parameter_table.hpp"
#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

struct Signals;
struct Handover;

/// Receives a module's private quantities. Each call gives one number with its name and unit.
class ProbeVisitor {
 public:
  virtual ~ProbeVisitor() = default;
  virtual void operator()(std::string_view name, double value, std::string_view unit) = 0;
  /// Three numbers: `name.x`, `name.y`, `name.z`.
  virtual void operator()(std::string_view name, const Vector3& value, std::string_view unit) = 0;
};

/// What every exchangeable part of the autopilot has: a period, parameters, probes, a reset.
///
/// A module is a pure stepping object. It never reads a clock, never blocks, never allocates while it works,
/// and never looks at a neighbour: what it needs comes as arguments.
class Module {
 public:
  Module() = default;
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;
  virtual ~Module() = default;

  /// How often the work function runs, ns; 0: at every IMU sample. A multiple of the IMU period.
  Time period() const { return period_; }
  void set_period(Time period) { period_ = period; }

  /// Back to the state after construction. Parameters stay.
  virtual void reset() = 0;

  /// Registers the module's parameters under `prefix`. Tunable does this.
  virtual void register_parameters(ParameterTable&, const std::string& /*prefix*/) {}

  /// Called after a parameter changed in flight, between two ticks.
  virtual void parameters_changed() {}

  /// Called after parameters were set before flight: they are what the module is configured to.
  virtual void parameters_configured() { parameters_changed(); }

  /// Called on a newcomer of the same kind: its changes in flight are measured by what its predecessor was
  /// configured to, not by what had been made of that.
  virtual void configured_like(const Module& /*predecessor*/) {}

  /// Which of the present parameters is so far from what was configured that a vehicle in flight could come
  /// down; empty when none is.
  virtual std::string_view parameter_danger() const { return {}; }

  /// Which of the present parameters do not fit together; empty when all do.
  virtual std::string_view parameter_conflict() const { return {}; }

  /// Shows private quantities worth plotting. The names and their order may not change during a run.
  virtual void probe(ProbeVisitor&) const {}

  /// Why this module could not go on from where the last tick left the flight; empty when it can. Asked of a
  /// newcomer before it replaces another module.
  virtual std::string objection(const Signals&) const { return {}; }

  /// Called on a module that is about to be replaced: writes what was granted to it since the last tick, and
  /// what it has not worked on yet. PathPlanner and Controller do this for every kind; a kind that holds back
  /// more, as SequencedManager does for its period, adds it.
  virtual void hand_over(Handover&) const {}

  /// Called once on a module that replaces another one in flight, with all that the last tick computed and
  /// what its predecessor leaves, so that it can start where that stopped.
  virtual void take_over(const Handover&) {}

 private:
  Time period_{0};
};

/// Decides, from integers only, whether a module's work is due, and how much time passed since its last work.
class Divider {
 public:
  /// True when work is due at `now`. Sets `dt` to the time since the work before, s; 0 on the first.
  bool due(Time now, Time period, double& dt) {
    if (started_ && period.count() > 0 && now < next_) return false;
    dt = started_ ? seconds(now - last_) : 0.0;
    next_ = (started_ && next_ + period > now ? next_ : now) + period;
    last_ = now;
    started_ = true;
    return true;
  }

  void reset() { started_ = false; }

 private:
  bool started_ = false;
  Time last_{0};
  Time next_{0};
};

}  // namespace ironbird::autopilot
