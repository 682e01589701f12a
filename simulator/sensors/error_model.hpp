#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "simulator/random/stream.hpp"
#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

// The errors that every sensor has in common. A reading is
//
//   y = clamp(quantise((I + diag(scale)) R x + bias + instability + walk + white))
//
// with x the true value in the sensor's nominal axes. Noise models: IEEE Std 952, annex C.

/// How the driving noise of a first-order Gauss-Markov process is scaled.
enum class GaussMarkovScheme : std::uint8_t {
  kStationary,       ///< by sqrt(1 - exp(-2 T/tau)): `sigma` is the standard deviation, from the start on
  kNoiseTimesPeriod  ///< by the sample period T, from zero: what the reference simulator does
};

constexpr std::array<std::pair<GaussMarkovScheme, std::string_view>, 2> enumerators(GaussMarkovScheme) {
  return {{{GaussMarkovScheme::kStationary, "stationary"},
           {GaussMarkovScheme::kNoiseTimesPeriod, "noise_times_period"}}};
}

/// Units of an error model, one set per measured quantity.
struct AccelerationUnits {
  static constexpr const char* kValue = "m/s^2";
  static constexpr const char* kDensity = "m/s^2/sqrt(Hz)";
  static constexpr const char* kWalk = "m/s^2/sqrt(s)";
};
struct AngularRateUnits {
  static constexpr const char* kValue = "rad/s";
  static constexpr const char* kDensity = "rad/s/sqrt(Hz)";
  static constexpr const char* kWalk = "rad/s/sqrt(s)";
};
struct MagneticFieldUnits {
  static constexpr const char* kValue = "T";
  static constexpr const char* kDensity = "T/sqrt(Hz)";
  static constexpr const char* kWalk = "T/sqrt(s)";
};
struct PressureUnits {
  static constexpr const char* kValue = "Pa";
  static constexpr const char* kDensity = "Pa/sqrt(Hz)";
  static constexpr const char* kWalk = "Pa/sqrt(s)";
};
struct LengthUnits {
  static constexpr const char* kValue = "m";
  static constexpr const char* kDensity = "m/sqrt(Hz)";
  static constexpr const char* kWalk = "m/sqrt(s)";
};
struct SpeedUnits {
  static constexpr const char* kValue = "m/s";
  static constexpr const char* kDensity = "m/s/sqrt(Hz)";
  static constexpr const char* kWalk = "m/s/sqrt(s)";
};
struct VoltageUnits {
  static constexpr const char* kValue = "V";
  static constexpr const char* kDensity = "V/sqrt(Hz)";
  static constexpr const char* kWalk = "V/sqrt(s)";
};
struct CurrentUnits {
  static constexpr const char* kValue = "A";
  static constexpr const char* kDensity = "A/sqrt(Hz)";
  static constexpr const char* kWalk = "A/sqrt(s)";
};

/// The errors of one axis. In the unit of the measured quantity. All zero: a perfect sensor.
struct AxisErrorParams {
  double turn_on_sigma = 0.0;
  double turn_on_range = 0.0;
  double instability_sigma = 0.0;
  double instability_time_constant = 100.0;
  GaussMarkovScheme instability_scheme = GaussMarkovScheme::kStationary;
  double random_walk = 0.0;
  double walk_per_sample = 0.0;
  double noise_density = 0.0;
  double noise_sigma = 0.0;
  double resolution = 0.0;
  std::optional<double> full_scale;

  template <class Units, class Self, class Visit>
  static void describe_in(Self& self, Visit&& visit) {
    visit("turn_on_sigma", self.turn_on_sigma, Units::kValue,
          "1 sigma of the part of the bias drawn once per run", 0.0, 1e6);
    visit("turn_on_range", self.turn_on_range, Units::kValue,
          "half the width of the uniform part of the bias drawn once per run", 0.0, 1e6);
    visit("instability_sigma", self.instability_sigma, Units::kValue,
          "bias instability, a first-order Gauss-Markov process", 0.0, 1e6);
    visit("instability_time_constant", self.instability_time_constant, "s",
          "correlation time of the instability", 1e-6, 1e9);
    visit("instability_scheme", self.instability_scheme, "1", "how the instability's noise is scaled");
    visit("random_walk", self.random_walk, Units::kWalk, "bias walk, standard deviation after one second",
          0.0, 1e6);
    visit("walk_per_sample", self.walk_per_sample, Units::kValue,
          "bias walk, standard deviation of one sample's step whatever the rate", 0.0, 1e6);
    visit("noise_density", self.noise_density, Units::kDensity,
          "white noise; a sample has density / sqrt(period)", 0.0, 1e6);
    visit("noise_sigma", self.noise_sigma, Units::kValue, "white noise of a sample whatever the rate", 0.0,
          1e6);
    visit("resolution", self.resolution, Units::kValue, "step of the output; 0: continuous", 0.0, 1e6);
    visit("full_scale", self.full_scale, Units::kValue, "greatest magnitude of the output", 0.0, 1e9);
  }
};

/// The errors of a sensor of one number.
template <class Units>
struct ScalarErrorParams : AxisErrorParams {
  double bias = 0.0;
  double scale = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("bias", self.bias, Units::kValue, "constant bias", -1e6, 1e6);
    visit("scale", self.scale, "1", "relative error of the scale", -1.0, 1.0);
    AxisErrorParams::describe_in<Units>(self, visit);
  }
};

/// The errors of three axes: those of each, and those of the triad.
struct TriadErrorParams : AxisErrorParams {
  Vector3 bias = Vector3::Zero();
  Vector3 scale = Vector3::Zero();
  Vector3 misalignment = Vector3::Zero();
  double scale_sigma = 0.0;
  double misalignment_sigma = 0.0;
  Vector3 decaying_bias = Vector3::Zero();
  double decaying_bias_time_constant = 400.0;

  template <class Units, class Self, class Visit>
  static void describe_in(Self& self, Visit&& visit) {
    visit("bias", self.bias, Units::kValue, "constant bias", -1e6, 1e6);
    visit("scale", self.scale, "1", "relative error of the scale, per axis", -1.0, 1.0);
    visit("misalignment", self.misalignment, "rad", "turn of the sensor's axes, rotation vector", -1.0, 1.0);
    visit("scale_sigma", self.scale_sigma, "1", "1 sigma of the part of `scale` drawn once per run", 0.0,
          1.0);
    visit("misalignment_sigma", self.misalignment_sigma, "rad",
          "1 sigma per axis of the part of `misalignment` drawn once per run", 0.0, 1.0);
    visit("decaying_bias", self.decaying_bias, Units::kValue, "bias that dies out after power-up", -1e6, 1e6);
    visit("decaying_bias_time_constant", self.decaying_bias_time_constant, "s",
          "how long the decaying bias lasts", 1e-6, 1e9);
    AxisErrorParams::describe_in<Units>(self, visit);
  }
};

/// The errors of a sensor of three axes.
template <class Units>
struct VectorErrorParams : TriadErrorParams {
  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    TriadErrorParams::describe_in<Units>(self, visit);
  }
};

/// First-order Gauss-Markov process, exact for the sample period whatever its length.
class GaussMarkov {
 public:
  /// @param sigma          see `scheme`, >= 0
  /// @param time_constant  s, > 0
  /// @param period         of the samples, s, > 0
  GaussMarkov(double sigma, double time_constant, double period, GaussMarkovScheme scheme, std::uint64_t seed,
              std::string_view name);

  /// Advances by one period. @return the new value; 0 without a draw when sigma is 0
  double next();

 private:
  Stream stream_;
  double decay_;
  double gain_;
  double value_ = 0.0;
};

/// The additive errors and the output stage of one axis.
class AxisError {
 public:
  /// @param bias    constant, in the unit of the axis
  /// @param period  of the samples, s, > 0
  /// @param name    of the axis, for example "sensors/imu/gyro/x"; each noise source adds its own word
  AxisError(const AxisErrorParams& params, double bias, double period, std::uint64_t seed,
            const std::string& name);

  /// The sum of all errors of the next sample. @param white_sigma  of this sample's white noise, >= 0
  double next(double white_sigma);
  double next() { return next(white_sigma_); }

  /// Quantised and limited to the full scale.
  double read_out(double value) const;

  /// Standard deviation of the white noise of a sample.
  double white_sigma() const { return white_sigma_; }

  /// Mean of the bias in this run: constant plus turn-on.
  double bias() const { return bias_; }

 private:
  Stream walk_stream_;
  Stream white_stream_;
  GaussMarkov instability_;
  double bias_;
  double walk_sigma_;
  double walk_ = 0.0;
  double white_sigma_;
  double resolution_;
  std::optional<double> full_scale_;
};

/// A sensor of one number.
class ScalarError {
 public:
  template <class Units>
  ScalarError(const ScalarErrorParams<Units>& params, double period, std::uint64_t seed,
              const std::string& name)
      : axis_(params, params.bias, period, seed, name), gain_(1.0 + params.scale) {}

  /// What the sensor reads. @param value  true value @param offset  added before the output stage
  double apply(double value, double offset = 0.0) {
    return axis_.read_out(gain_ * value + axis_.next() + offset);
  }

 private:
  AxisError axis_;
  double gain_;
};

/// A sensor of three axes.
class VectorError {
 public:
  VectorError(const TriadErrorParams& params, double period, std::uint64_t seed, const std::string& name);

  /// What the sensor reads.
  /// @param value        true value in the sensor's nominal axes
  /// @param offset       added before the output stage, in the same axes
  /// @param white_sigma  of this sample's white noise, per axis, >= 0
  Vector3 apply(const Vector3& value, const Vector3& offset, double white_sigma);
  Vector3 apply(const Vector3& value, const Vector3& offset) { return apply(value, offset, white_sigma()); }

  double white_sigma() const { return axes_[0].white_sigma(); }

 private:
  Matrix3 gain_;
  std::array<AxisError, 3> axes_;
  Vector3 decaying_bias_;
  double decay_;
};

}  // namespace ironbird::simulator
