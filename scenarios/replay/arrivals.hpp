#pragma once

#include <chrono>
#include <cstdint>
#include <variant>

#include "hil_bridge/fcu/fcu.hpp"

// What the readers of recorded flights share who make a unit's messages of them.

namespace ironbird::scenarios {

/// How often a unit tells its status.
inline constexpr hil_bridge::Time kStatusPeriod = std::chrono::milliseconds(100);

/// A time as the wire's stamps are, us. What lies before the first sample of the IMU is at it.
inline std::uint64_t wire_stamp(hil_bridge::Time time) {
  return time > hil_bridge::Time::zero() ? static_cast<std::uint64_t>(time.count() / 1000) : 0;
}

inline bool is_imu(const hil_bridge::Arrival& arrival) {
  return std::holds_alternative<hil_bridge::rosflight::SmallImu>(arrival.message);
}

}  // namespace ironbird::scenarios
