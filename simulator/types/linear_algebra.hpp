#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ironbird::simulator {

using Vector3 = Eigen::Matrix<double, 3, 1>;
using Matrix3 = Eigen::Matrix<double, 3, 3>;
/// Hamilton quaternion. `q_NB` takes B components to N.
using Quaternion = Eigen::Quaternion<double>;

}  // namespace ironbird::simulator
