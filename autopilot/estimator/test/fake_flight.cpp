#include "autopilot/estimator/test/fake_flight.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kSpeedOfTime = 1.0e9;        // ns/s
constexpr double kEarth = 6378145.0;          // m
constexpr double kExponentOf1976 = 5.255876;  // g M/(R L)

/// A sine with its first two derivatives.
struct Wave {
  double value, first, second;
  Wave(double amplitude, double rate, double tau)
      : value(amplitude * std::sin(rate * tau)),
        first(amplitude * rate * std::cos(rate * tau)),
        second(-amplitude * rate * rate * std::sin(rate * tau)) {}
};

Matrix3 axis_rotation(int axis, double angle) {
  return Eigen::AngleAxisd(angle, Vector3::Unit(axis)).toRotationMatrix();
}

}  // namespace

FakeTruth FakePath::at(double t) const {
  // tau_dot rises from 0 to pace as 3 s^2 - 2 s^3.
  const double s = std::clamp((t - rest) / blend, 0.0, 1.0);
  const double late = std::max(0.0, t - rest - blend);
  const double tau = pace * (blend * (s * s * s - 0.5 * s * s * s * s) + late);
  const double tau_1 = pace * (3.0 * s * s - 2.0 * s * s * s);
  const double tau_2 = s < 1.0 ? pace * (6.0 * s - 6.0 * s * s) / blend : 0.0;
  const std::array<Wave, 3> p = {Wave(15.0, 0.20, tau), Wave(12.0, 0.27, tau), Wave(-6.0, 0.11, tau)};
  const std::array<Wave, 3> angle = {Wave(0.20, 0.7, tau), Wave(0.15, 0.9, tau), Wave(1.5, 0.15, tau)};
  FakeTruth x;
  Vector3 theta_dot;
  for (int i = 0; i < 3; ++i) {
    x.p_N[i] = p[i].value;
    x.v_N[i] = p[i].first * tau_1;
    x.a_N[i] = p[i].second * tau_1 * tau_1 + p[i].first * tau_2;
    x.theta[i] = angle[i].value;
    theta_dot[i] = angle[i].first * tau_1;
  }
  x.theta[2] += first_heading;
  const Matrix3 roll = axis_rotation(0, x.theta[0]);
  const Matrix3 pitch = axis_rotation(1, x.theta[1]);
  x.R_NB = axis_rotation(2, x.theta[2]) * pitch * roll;
  // Rates about the three axes of the sequence, each brought into B.
  x.w_B = theta_dot[0] * Vector3::UnitX() + roll.transpose() * (theta_dot[1] * Vector3::UnitY()) +
          roll.transpose() * pitch.transpose() * (theta_dot[2] * Vector3::UnitZ());
  return x;
}

double FakeSensors::normal() {
  const double u = (static_cast<double>(generator_() >> 11) + 0.5) * 0x1.0p-53;
  const double v = (static_cast<double>(generator_() >> 11) + 0.5) * 0x1.0p-53;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

double FakeSensors::walk_step(double& value, double sigma, double time_constant, double dt) {
  const double kept = std::exp(-dt / time_constant);
  value = kept * value + sigma * std::sqrt(1.0 - kept * kept) * normal();
  return value;
}

MagSample FakeSensors::mag(const FakeTruth& now) {
  const double azimuth = declination + errors.compass;
  const Vector3 m_N(std::cos(inclination) * std::cos(azimuth), std::cos(inclination) * std::sin(azimuth),
                    std::sin(inclination));
  MagSample sample;
  sample.m_B = now.R_NB.transpose() * m_N + errors.mag * normal3();
  for (int i = 0; i < 3; ++i) {
    sample.m_B[i] +=
        walk_step(mag_error_[i], errors.mag_walk, errors.mag_time_constant, mag_every / imu_rate);
  }
  sample.m_B *= 50.7;  // any unit will do
  return sample;
}

BaroSample FakeSensors::baro(const FakeTruth& now) {
  baro_error_ += errors.baro_walk * std::sqrt(baro_every / imu_rate) * normal();
  BaroSample sample;
  const double height = altitude - now.p_N.z();
  sample.pressure = 101325.0 * std::pow(1.0 - 0.0065 * height / 288.15, kExponentOf1976) + baro_error_ +
                    errors.baro * normal();
  return sample;
}

GnssSample FakeSensors::gnss() {
  const double dt = gnss_every / imu_rate;
  const FakeTruth now = truth();
  Vector3 p_N = now.p_N + errors.gnss * normal3() + gnss_jump;
  for (int i = 0; i < 3; ++i) {
    p_N[i] +=
        walk_step(gnss_error_[i], (i == 2 ? 1.9 : 1.0) * errors.gnss_walk, errors.gnss_time_constant, dt);
  }
  GnssSample fix;
  fix.latitude = latitude + p_N.x() / kEarth;
  fix.longitude = longitude + p_N.y() / (kEarth * std::cos(latitude));
  fix.altitude = altitude - p_N.z();
  fix.v_NB_N = now.v_N + errors.gnss_velocity * normal3();
  fix.horizontal_accuracy = 0.5;
  fix.vertical_accuracy = 0.8;
  fix.speed_accuracy = 0.05;
  fix.fix = GnssFix::kFix3D;
  fix.satellites = 15;
  return fix;
}

SensorFrame FakeSensors::next() {
  ++tick_;
  const Time stamp(static_cast<std::int64_t>(std::llround(time() * kSpeedOfTime)));
  const FakeTruth now = truth();
  SensorFrame frame;
  frame.imu.stamp = stamp;
  frame.imu.f_B = now.R_NB.transpose() * (now.a_N - gravity * Vector3::UnitZ()) + errors.accelerometer_bias +
                  errors.accelerometer * normal3();
  frame.imu.w_NB_B = now.w_B + errors.gyro_bias + errors.gyro * normal3();
  if (mag_on && tick_ % mag_every == 0) {
    frame.mag = mag(now);
    frame.mag->stamp = stamp;
  }
  if (baro_on && tick_ % baro_every == 0) {
    frame.baro = baro(now);
    frame.baro->stamp = stamp;
  }
  if (tick_ % gnss_every == 0) {
    on_the_way_.push_back(gnss());
    on_the_way_.back().stamp = stamp;
  }
  const Time latency(static_cast<std::int64_t>(std::llround(errors.latency * kSpeedOfTime)));
  if (!on_the_way_.empty() && on_the_way_.front().stamp + latency <= stamp) {
    if (gnss_on) frame.gnss = on_the_way_.front();
    on_the_way_.pop_front();
  }
  return frame;
}

}  // namespace ironbird::autopilot
