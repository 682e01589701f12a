#pragma once

#include <cstdint>
#include <string_view>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// What a motor command of this vehicle may be.
struct CommandLimits {
  double thrust = 0.0;
  double torque = 0.0;
  double angle = 0.0;
  double rate = 0.0;
  Time greatest_age{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("thrust", self.thrust, "N", "greatest force of a pass-through command, upwards only");
    visit("torque", self.torque, "N*m", "greatest torque of a pass-through command, about any axis");
    visit("angle", self.angle, "rad", "greatest roll or pitch angle");
    visit("rate", self.rate, "rad/s", "greatest angular rate");
    visit("greatest_age", self.greatest_age, "ns", "from the sensors that it answers to its leaving");
  }
};

/// Why a command does not pass.
enum class CommandFault : std::uint8_t { kNone, kNotFinite, kOutOfRange, kUnknownMode, kStale, kRepeated };

std::string_view name_of(CommandFault fault);

/// A command and where it comes from.
struct StampedCommand {
  rosflight::OffboardControl command;
  Time answers{};            ///< bench time of the sensors that it answers
  std::uint64_t number = 0;  ///< of the autopilot's step; each one counts once
};

/// Looks at one command after the other.
class CommandCheck {
 public:
  explicit CommandCheck(const CommandLimits& limits) : limits_(limits) {}
  CommandFault check(const StampedCommand& command, Time now);

 private:
  CommandLimits limits_;
  std::uint64_t last_number_ = 0;
};

/// No thrust and no torque: motors idle if the unit is armed.
rosflight::OffboardControl zero_command();

}  // namespace ironbird::hil_bridge
