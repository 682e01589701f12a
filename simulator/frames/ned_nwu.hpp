#pragma once

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

// The one place where frames change. Inside an engine the world is north-west-up and the body
// forward-left-up: half a turn about x on both sides. Its own inverse, and exact to the bit, because only
// signs change.

/// Any vector, from N to the engine's world, from B to the engine's body, or back.
inline Vector3 ned_nwu(const Vector3& v) {
  return {v.x(), -v.y(), -v.z()};
}

/// The attitude of B in N as that of the engine's body in the engine's world, or back.
inline Quaternion ned_nwu(const Quaternion& q) {
  return {q.w(), q.x(), -q.y(), -q.z()};
}

}  // namespace ironbird::simulator
