#include "hil_bridge/interlock/command_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ironbird::hil_bridge {

namespace {

constexpr std::size_t kForceZ = 2;
constexpr std::size_t kRoll = 3;
constexpr std::size_t kYaw = 5;
enum Mode : std::uint8_t { kPassThrough = 0, kRates = 1, kAngles = 2 };

// What single precision makes of a value that stands exactly at its limit.
constexpr double kRounding = 1.0 + 1e-6;

bool within(float value, double lower, double upper) {
  const auto real = static_cast<double>(value);
  return real >= lower * kRounding && real <= upper * kRounding;
}

bool in_range(const rosflight::OffboardControl& command, const CommandLimits& limits) {
  const bool direct = command.mode == kPassThrough;
  // A multirotor pushes along its own z axis only: upwards is negative in pass-through, positive as throttle.
  if (command.u[0] != 0.0F || command.u[1] != 0.0F) return false;
  if (!within(command.u[kForceZ], direct ? -limits.thrust : 0.0, direct ? 0.0 : 1.0)) return false;
  for (std::size_t k = kRoll; k <= kYaw; ++k) {
    const bool angle = command.mode == kAngles && k != kYaw;
    const double limit = direct ? limits.torque : angle ? limits.angle : limits.rate;
    if (!within(command.u[k], -limit, limit)) return false;
  }
  // The free inputs of the mixer are nobody's.
  return std::all_of(command.u.begin() + kYaw + 1, command.u.end(),
                     [](float value) { return value == 0.0F; });
}

}  // namespace

std::string_view name_of(CommandFault fault) {
  constexpr std::array<std::string_view, 6> kNames = {"none",         "not finite", "out of range",
                                                      "unknown mode", "stale",      "repeated"};
  return kNames[static_cast<std::size_t>(fault)];
}

CommandFault CommandCheck::check(const StampedCommand& command, Time now) {
  const auto& u = command.command.u;
  if (!std::all_of(u.begin(), u.end(), [](float value) { return std::isfinite(value); })) {
    return CommandFault::kNotFinite;
  }
  if (command.command.mode > kAngles) return CommandFault::kUnknownMode;
  if (!in_range(command.command, limits_)) return CommandFault::kOutOfRange;
  if (command.answers > now || now - command.answers > limits_.greatest_age) return CommandFault::kStale;
  if (command.number <= last_number_) return CommandFault::kRepeated;
  last_number_ = command.number;
  return CommandFault::kNone;
}

rosflight::OffboardControl zero_command() {
  return {};
}

}  // namespace ironbird::hil_bridge
