#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// How far an estimate may be trusted.
enum class Health : std::uint8_t {
  kUninitialised,  ///< no estimate yet: do not fly on it
  kGood,
  kDegraded,  ///< coasting without one of its sensors
  kLost       ///< not even height and attitude are to be trusted: do not fly on it
};

/// Every value of Health with its name in files and logs.
constexpr std::array<std::pair<Health, std::string_view>, 4> enumerators(Health) {
  return {{{Health::kUninitialised, "uninitialised"},
           {Health::kGood, "good"},
           {Health::kDegraded, "degraded"},
           {Health::kLost, "lost"}}};
}

/// There is an estimate, and its height and attitude may be flown on.
constexpr bool is_usable(Health health) {
  return health == Health::kGood || health == Health::kDegraded;
}

/// Where latitude, longitude and altitude of the local frame N begin.
struct LocalOrigin {
  bool known = false;
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("known", self.known, "1", "the origin has been set");
    visit("latitude", self.latitude, "rad", "geodetic latitude, north positive");
    visit("longitude", self.longitude, "rad", "longitude, east positive");
    visit("altitude", self.altitude, "m", "height above mean sea level");
  }
};

/// Where the vehicle is, how it moves, and how sure we are.
struct StateEstimate {
  Time stamp{};
  Vector3 p_NB_N = Vector3::Zero();
  Vector3 v_NB_B = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  double roll = 0.0;
  double pitch = 0.0;
  double heading = 0.0;
  Vector3 w_NB_B = Vector3::Zero();
  Vector3 gyro_bias_B = Vector3::Zero();
  Vector3 accelerometer_bias_B = Vector3::Zero();
  Vector3 sigma_p_N = Vector3::Zero();
  Vector3 sigma_v_B = Vector3::Zero();
  Vector3 sigma_attitude = Vector3::Zero();
  LocalOrigin origin;
  bool position_known = true;
  double position_age = 0.0;
  bool position_doubtful = false;
  Vector3 position_offset_N = Vector3::Zero();
  std::uint32_t position_resets = 0;
  Vector3 position_reset_sum_N = Vector3::Zero();
  Health health = Health::kUninitialised;

  /// Velocity over ground in N, m/s.
  Vector3 v_NB_N() const { return q_NB * v_NB_B; }

  /// Cosine of the lean, the angle from Nz to Bz.
  double upright() const { return 1.0 - 2.0 * (q_NB.x() * q_NB.x() + q_NB.y() * q_NB.y()); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "stamp of the IMU sample that the estimate belongs to");
    visit("p_NB_N", self.p_NB_N, "m", "position of B from the local origin");
    visit("v_NB_B", self.v_NB_B, "m/s", "velocity over ground in body axes");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit("roll", self.roll, "rad", "ZYX Euler angle");
    visit("pitch", self.pitch, "rad", "ZYX Euler angle");
    visit("heading", self.heading, "rad", "ZYX Euler angle, from true north, (-pi, pi]");
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity, bias removed, low-passed");
    visit("gyro_bias_B", self.gyro_bias_B, "rad/s", "bias of the gyro");
    visit("accelerometer_bias_B", self.accelerometer_bias_B, "m/s^2",
          "bias of the accelerometer; 0 when not estimated");
    visit("sigma_p_N", self.sigma_p_N, "m", "1 sigma of p_NB_N");
    visit("sigma_v_B", self.sigma_v_B, "m/s", "1 sigma of v_NB_B");
    visit("sigma_attitude", self.sigma_attitude, "rad", "1 sigma of roll, pitch, heading");
    visit("origin", self.origin, "", "where N begins");
    visit("position_known", self.position_known, "1",
          "horizontal position and velocity can be flown on; false: height and attitude only");
    visit("position_age", self.position_age, "s", "since the horizontal position was last measured");
    visit("position_doubtful", self.position_doubtful, "1",
          "fixes and dead reckoning disagree, whichever is wrong: p_NB_N is dead reckoning's, where N lies "
          "on the earth is doubtful");
    visit("position_offset_N", self.position_offset_N, "m", "by how much they do, taken off the fixes");
    visit("position_resets", self.position_resets, "1",
          "how often the horizontal position jumped, by a reset or a large correction");
    visit("position_reset_sum_N", self.position_reset_sum_N, "m",
          "how far all its jumps took it: who looks now and then moves along by the difference");
    visit("health", self.health, "1", "how far the estimate may be trusted");
  }
};

}  // namespace ironbird::autopilot
