#include "simulator/sensors/error_model.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {

namespace {

/// The integer nearest to `value`, by pushing its fraction out of the mantissa: the library's call costs as
/// much as a random number. From 2^51 on every double that matters is an integer already.
double nearest_integer(double value) {
  constexpr double kShift = 0x1.8p52;
  return std::abs(value) < 0x1.0p51 ? (value + kShift) - kShift : value;
}

Vector3 normal_vector(Stream& stream) {
  const double x = stream.normal();
  const double y = stream.normal();
  const double z = stream.normal();
  return Vector3(x, y, z);
}

Matrix3 gain_of(const TriadErrorParams& params, std::uint64_t seed, const std::string& name) {
  Stream scale_stream(seed, name + "/scale");
  Stream misalignment_stream(seed, name + "/misalignment");
  const Vector3 scale = params.scale + params.scale_sigma * normal_vector(scale_stream);
  const Vector3 turn = params.misalignment + params.misalignment_sigma * normal_vector(misalignment_stream);
  const double angle = turn.norm();
  const Vector3 axis = angle > 0.0 ? Vector3(turn / angle) : Vector3(Vector3::UnitX());
  const Matrix3 R_turned_nominal = Eigen::AngleAxis<double>(angle, axis).toRotationMatrix().transpose();
  return (Vector3::Ones() + scale).asDiagonal() * R_turned_nominal;
}

}  // namespace

GaussMarkov::GaussMarkov(double sigma, double time_constant, double period, GaussMarkovScheme scheme,
                         std::uint64_t seed, std::string_view name)
    : stream_(seed, name), decay_(std::exp(-period / time_constant)) {
  if (scheme == GaussMarkovScheme::kNoiseTimesPeriod) {
    gain_ = sigma * period;
    return;
  }
  // 1 - exp(-2 T/tau) without cancellation.
  gain_ = sigma * std::sqrt(-std::expm1(-2.0 * period / time_constant));
  if (sigma > 0.0) value_ = sigma * stream_.normal();
}

double GaussMarkov::next() {
  if (gain_ == 0.0) return 0.0;
  value_ = decay_ * value_ + gain_ * stream_.normal();
  return value_;
}

AxisError::AxisError(const AxisErrorParams& params, double bias, double period, std::uint64_t seed,
                     const std::string& name)
    : walk_stream_(seed, name + "/walk"),
      white_stream_(seed, name + "/white"),
      instability_(params.instability_sigma, params.instability_time_constant, period,
                   params.instability_scheme, seed, name + "/instability"),
      bias_(bias),
      walk_sigma_(std::hypot(params.random_walk * std::sqrt(period), params.walk_per_sample)),
      white_sigma_(std::hypot(params.noise_density / std::sqrt(period), params.noise_sigma)),
      resolution_(params.resolution),
      full_scale_(params.full_scale) {
  Stream normal_stream(seed, name + "/turn_on_normal");
  Stream uniform_stream(seed, name + "/turn_on_uniform");
  bias_ += params.turn_on_sigma * normal_stream.normal();
  bias_ += params.turn_on_range * uniform_stream.uniform(-1.0, 1.0);
}

double AxisError::next(double white_sigma) {
  double error = bias_ + instability_.next();
  if (walk_sigma_ > 0.0) {
    walk_ += walk_sigma_ * walk_stream_.normal();
    error += walk_;
  }
  if (white_sigma > 0.0) error += white_sigma * white_stream_.normal();
  return error;
}

double AxisError::read_out(double value) const {
  if (resolution_ > 0.0) value = resolution_ * nearest_integer(value / resolution_);
  if (full_scale_) value = std::clamp(value, -*full_scale_, *full_scale_);
  return value;
}

VectorError::VectorError(const TriadErrorParams& params, double period, std::uint64_t seed,
                         const std::string& name)
    : gain_(gain_of(params, seed, name)),
      axes_{AxisError(params, params.bias.x(), period, seed, name + "/x"),
            AxisError(params, params.bias.y(), period, seed, name + "/y"),
            AxisError(params, params.bias.z(), period, seed, name + "/z")},
      decaying_bias_(params.decaying_bias),
      decay_(params.decaying_bias_time_constant / (params.decaying_bias_time_constant + period)) {}

Vector3 VectorError::apply(const Vector3& value, const Vector3& offset, double white_sigma) {
  decaying_bias_ *= decay_;
  Vector3 reading = gain_ * value + offset + decaying_bias_;
  for (int i = 0; i < 3; ++i) {
    AxisError& axis = axes_[static_cast<std::size_t>(i)];
    reading[i] = axis.read_out(reading[i] + axis.next(white_sigma));
  }
  return reading;
}

}  // namespace ironbird::simulator
