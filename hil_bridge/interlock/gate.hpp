#pragma once

#include <cstdint>
#include <optional>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// What a message can do to a unit.
enum class Effect : std::uint8_t {
  kAsks,     ///< nothing: it asks, or says that somebody is there
  kInforms,  ///< its attitude filter takes it for a measurement
  kChanges,  ///< parameters, calibration, flash, restart
  kMoves,    ///< can turn a motor
};

Effect effect_of(const rosflight::Message& message);

/// Decides, message by message, what leaves the bench towards a unit. Whoever writes to a line asks it first.
class Gate {
 public:
  virtual ~Gate() = default;

  /// @return the message that leaves instead of this one, which may be the same, or none
  virtual std::optional<rosflight::Message> pass(const rosflight::Message& message, Time now) = 0;
};

/// Lets questions pass, and nothing else.
class QuestionGate final : public Gate {
 public:
  std::optional<rosflight::Message> pass(const rosflight::Message& message, Time) override {
    return effect_of(message) == Effect::kAsks ? std::optional(message) : std::nullopt;
  }
};

/// Lets everything pass. For units that exist in this process only: their propellers are numbers.
class SimulatedUnitGate final : public Gate {
 public:
  std::optional<rosflight::Message> pass(const rosflight::Message& message, Time) override { return message; }
};

}  // namespace ironbird::hil_bridge
