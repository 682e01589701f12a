#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <numbers>
#include <random>

#include "autopilot/types/sensor_frame.hpp"

namespace ironbird::autopilot {

// A made-up flight with closed-form derivatives, and sensors that can be stopped and broken. Test code only.

/// What is true at one moment.
struct FakeTruth {
  Vector3 p_N, v_N, a_N;
  Vector3 theta;  ///< roll, pitch, heading
  Vector3 w_B;
  Matrix3 R_NB;
};

/// Rests at the origin, then moves on sums of sines with an attitude of its own: no physics, any acceleration
/// at any attitude. Everything follows from two functions of the warped time tau(t).
struct FakePath {
  double rest = 4.0;           ///< s at the origin before the movement
  double blend = 4.0;          ///< s from rest to full pace
  double pace = 1.0;           ///< full pace: tau_dot
  double first_heading = 0.7;  ///< rad

  FakeTruth at(double t) const;
};

/// Sizes of the errors. White noise per sample; walks are Gauss-Markov.
struct FakeErrors {
  double gyro = 0.00226;       ///< rad/s
  double accelerometer = 0.2;  ///< m/s^2
  Vector3 gyro_bias = Vector3::Zero();
  Vector3 accelerometer_bias = Vector3::Zero();
  double mag = 0.002;                  ///< of the unit vector
  double mag_walk = 0.0;               ///< of the unit vector
  double mag_time_constant = 0.14;     ///< s
  double compass = 0.0;                ///< rad, constant heading error
  double baro = 4.0;                   ///< Pa
  double baro_walk = 0.0;              ///< Pa/sqrt(s)
  double gnss = 0.0;                   ///< m
  double gnss_walk = 0.0;              ///< m, 1 sigma in the long run; starts at 0
  double gnss_time_constant = 1100.0;  ///< s
  double gnss_velocity = 0.01;         ///< m/s
  double latency = 0.0;                ///< s, of the satellite fixes
};

/// Makes the frames of a flight, one per IMU period.
class FakeSensors {
 public:
  explicit FakeSensors(std::uint64_t seed) : generator_(seed) {}

  FakePath path;
  FakeErrors errors;
  double imu_rate = 400.0;
  int mag_every = 8;    ///< IMU samples: 50 Hz
  int baro_every = 4;   ///< 100 Hz
  int gnss_every = 40;  ///< 10 Hz
  bool mag_on = true;
  bool baro_on = true;
  bool gnss_on = true;
  Vector3 gnss_jump = Vector3::Zero();  ///< m, added to every fix
  double declination = 0.186;           ///< rad
  double inclination = 1.139;           ///< rad
  double latitude = 0.7024;             ///< rad
  double longitude = -1.9486;           ///< rad
  double altitude = 1387.0;             ///< m
  double gravity = 9.81;

  double time() const { return static_cast<double>(tick_) / imu_rate; }
  FakeTruth truth() const { return path.at(time()); }

  /// The next frame; afterwards `truth` is that of the frame.
  SensorFrame next();

 private:
  double normal();
  Vector3 normal3() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }
  double walk_step(double& value, double sigma, double time_constant, double dt);
  MagSample mag(const FakeTruth& now);
  BaroSample baro(const FakeTruth& now);
  GnssSample gnss();

  std::mt19937_64 generator_;
  std::int64_t tick_ = -1;
  std::array<double, 3> mag_error_{};
  std::array<double, 3> gnss_error_{};
  double baro_error_ = 0.0;
  std::deque<GnssSample> on_the_way_;
};

}  // namespace ironbird::autopilot
