#pragma once

#include <cstdint>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::scenarios {

/// A time as the wire's stamps are, us. What lies before the first sample of the IMU is at it.
inline std::uint64_t wire_stamp(hil_bridge::Time time) {
  return time > hil_bridge::Time::zero() ? static_cast<std::uint64_t>(time.count() / 1000) : 0;
}

}  // namespace ironbird::scenarios
