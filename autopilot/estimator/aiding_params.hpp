#pragma once

#include <optional>

namespace ironbird::autopilot {

// How the sensors are used: the parameters that all inertial filters share.

/// Satellite positioning.
struct GnssParams {
  double sigma_horizontal = 0.7;
  std::optional<double> sigma_vertical;  ///< m; none: the filter has no use for the height of a fix
  double sigma_velocity_horizontal = 0.06;
  double sigma_velocity_vertical = 0.1;
  bool use_receiver_accuracy = false;
  bool latency_compensation = true;
  double position_gate = 30.0;
  double gate_sigma = 1.5;
  double velocity_gate = 35.0;
  double persistence = 3.0;
  double silence = 1.0;
  double coast = 15.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("sigma_horizontal", self.sigma_horizontal, "m", "error of north and east, 1 sigma", 1e-4, 1e3);
    if (self.sigma_vertical) {
      visit("sigma_vertical", *self.sigma_vertical, "m", "error of height, 1 sigma", 1e-4, 1e3);
    }
    visit("sigma_velocity_horizontal", self.sigma_velocity_horizontal, "m/s",
          "error of the velocity north and east, 1 sigma", 1e-4, 1e2);
    visit("sigma_velocity_vertical", self.sigma_velocity_vertical, "m/s",
          "error of the velocity down, 1 sigma", 1e-4, 1e2);
    visit("use_receiver_accuracy", self.use_receiver_accuracy, "1",
          "take the receiver's own accuracy where it is worse than the sigmas");
    visit("latency_compensation", self.latency_compensation, "1",
          "compare a fix with the state at its own time, not at its arrival");
    visit("position_gate", self.position_gate, "1", "greatest normalised innovation squared; 0: no gate", 0.0,
          1e6);
    visit(
        "gate_sigma", self.gate_sigma, "m",
        "error of north and east, 1 sigma, that the position gate allows for at most, however little weight "
        "sigma_horizontal gives a fix",
        1e-4, 1e3);
    visit("velocity_gate", self.velocity_gate, "1", "greatest normalised innovation squared; 0: no gate", 0.0,
          1e6);
    visit("persistence", self.persistence, "s", "after so long a disagreement the filter is reset", 0.0,
          600.0);
    visit("silence", self.silence, "s", "without a usable fix for this long: degraded", 0.0, 600.0);
    visit("coast", self.coast, "s",
          "without a usable fix for this long the horizontal position is not known; nor, without the "
          "barometer, "
          "the height: lost",
          0.1, 600.0);
  }
};

/// Barometric height.
struct BaroParams {
  double sigma = 6.0;
  double air_density = 0.0;
  double gate = 36.0;
  double persistence = 3.0;
  double silence = 0.5;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("sigma", self.sigma, "Pa", "error of the pressure, 1 sigma", 1e-3, 1e5);
    visit("air_density", self.air_density, "kg/m^3",
          "overrides the standard atmosphere, without its decrease with height; 0: does not", 0.0, 2.0);
    visit("gate", self.gate, "1", "greatest normalised innovation squared; 0: no gate", 0.0, 1e6);
    visit("persistence", self.persistence, "s", "after so long a disagreement the filter is reset", 0.0,
          600.0);
    visit("silence", self.silence, "s", "without a sample for this long: degraded", 0.0, 600.0);
  }
};

/// Compass.
struct MagParams {
  double declination = 0.0;
  double sigma = 0.01;
  double sigma_tilt = 0.02;
  double gate = 36.0;
  double gate_sigma = 0.05;
  double persistence = 5.0;
  double silence = 0.5;
  double ground_sigma = 0.0;
  double ground_height = 1.5;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("declination", self.declination, "rad", "angle from true to magnetic north, east positive", -3.2,
          3.2);
    visit("sigma", self.sigma, "1", "error of each component of the unit vector, 1 sigma", 0.0, 1.0);
    visit("sigma_tilt", self.sigma_tilt, "rad", "error of the heading beyond that, 1 sigma", 1e-5, 3.0);
    visit("gate", self.gate, "1", "greatest normalised innovation squared; 0: no gate", 0.0, 1e6);
    visit("gate_sigma", self.gate_sigma, "rad",
          "error of the heading, 1 sigma, that the gate allows for at most, however little weight "
          "sigma_tilt gives a sample",
          1e-5, 3.0);
    visit("persistence", self.persistence, "s",
          "after so long a disagreement a heading that is in doubt is reset", 0.0, 600.0);
    visit("silence", self.silence, "s", "without a sample for this long: degraded", 0.0, 600.0);
    visit("ground_sigma", self.ground_sigma, "rad",
          "error of a heading that was found on the ground, 1 sigma, for the iron in it: after take-off the "
          "heading is sought anew; 0: the ground has none",
          0.0, 3.0);
    visit("ground_height", self.ground_height, "m",
          "above the start, beyond which the ground's iron is not felt", 0.0, 100.0);
  }
};

/// Finding the first state.
struct AlignmentParams {
  double duration = 1.0;
  int fixes = 5;
  int baro_samples = 50;
  double still_force = 0.6;
  double still_rate = 0.05;
  double still_speed = 0.5;
  double air_start_after = 3.0;
  bool remove_accelerometer_offset = true;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("duration", self.duration, "s", "least time of averaging", 0.1, 60.0);
    visit("fixes", self.fixes, "1", "satellite fixes averaged for the origin", 1.0, 1000.0);
    visit("baro_samples", self.baro_samples, "1", "samples of the pressure at the origin", 1.0, 512.0);
    visit("still_force", self.still_force, "m/s^2",
          "standard deviation of the accelerometer below which the vehicle rests", 0.0, 100.0);
    visit("still_rate", self.still_rate, "rad/s",
          "standard deviation of the gyro below which the vehicle rests", 0.0, 100.0);
    visit("still_speed", self.still_speed, "m/s", "speed over ground below which the vehicle rests", 0.0,
          100.0);
    visit("air_start_after", self.air_start_after, "s",
          "without rest for this long, or once armed, the filter starts in motion", 0.0, 600.0);
    visit("remove_accelerometer_offset", self.remove_accelerometer_offset, "1",
          "take the part of the bias along gravity, the only one seen at rest, off the accelerometer");
  }
};

/// How wrong the first state may be.
struct InitialSigmaParams {
  double position = 0.05;
  double velocity = 0.05;
  double tilt = 0.01;
  double heading = 0.05;
  double gyro_bias = 0.002;
  double air_velocity = 0.5;
  double air_tilt = 0.1;
  double air_heading = 0.2;
  double air_gyro_bias = 0.02;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("position", self.position, "m", "1 sigma", 0.0, 1e3);
    visit("velocity", self.velocity, "m/s", "at rest, 1 sigma", 0.0, 1e2);
    visit("tilt", self.tilt, "rad", "of roll and pitch, at rest, 1 sigma", 0.0, 3.0);
    visit("heading", self.heading, "rad", "at rest, 1 sigma", 0.0, 3.0);
    visit("gyro_bias", self.gyro_bias, "rad/s", "at rest, 1 sigma", 0.0, 1.0);
    visit("air_velocity", self.air_velocity, "m/s", "in motion, 1 sigma", 0.0, 1e2);
    visit("air_tilt", self.air_tilt, "rad", "of roll and pitch, in motion, 1 sigma", 0.0, 3.0);
    visit("air_heading", self.air_heading, "rad", "in motion, 1 sigma", 0.0, 3.0);
    visit("air_gyro_bias", self.air_gyro_bias, "rad/s", "in motion, 1 sigma", 0.0, 1.0);
  }
};

/// All of them, and what belongs to no sensor in particular.
struct AidingParams {
  double gravity = 9.81;
  double gyro_cutoff = 20.0;
  double lost_speed = 3.0;
  double lost_height = 20.0;
  double lost_tilt = 0.35;
  GnssParams gnss;
  BaroParams baro;
  MagParams mag;
  AlignmentParams alignment;
  InitialSigmaParams initial;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("gravity", self.gravity, "m/s^2", "acceleration of gravity", 1.0, 20.0);
    visit("gyro_cutoff", self.gyro_cutoff, "Hz", "low pass of the published rates; 0: none", 0.0, 1e4);
    visit("lost_speed", self.lost_speed, "m/s",
          "with a velocity less sure than this (1 sigma) the horizontal position is not known", 0.01, 1e3);
    visit("lost_height", self.lost_height, "m", "with a height less sure than this (1 sigma): lost", 0.1,
          1e4);
    visit("lost_tilt", self.lost_tilt, "rad", "with roll or pitch less sure than this (1 sigma): lost", 0.01,
          3.0);
    visit("gnss", self.gnss, "", "satellite positioning");
    visit("baro", self.baro, "", "barometric height");
    visit("mag", self.mag, "", "compass");
    visit("alignment", self.alignment, "", "finding the first state");
    visit("initial", self.initial, "", "how wrong the first state may be");
  }
};

}  // namespace ironbird::autopilot
