#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ironbird::autopilot {

using Vector2 = Eigen::Matrix<double, 2, 1>;
using Vector3 = Eigen::Matrix<double, 3, 1>;
using Matrix3 = Eigen::Matrix<double, 3, 3>;
/// Hamilton quaternion. `q_NB` takes B components to N. Built from (w, x, y, z) or an axis, never from raw
/// coefficients.
using Quaternion = Eigen::Quaternion<double>;

}  // namespace ironbird::autopilot
