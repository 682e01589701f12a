#include "simulator/render/camera.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace ironbird::simulator {
namespace {

// Below this sine of the angle to the vertical a camera looks straight up or down.
constexpr double kVertical = 1e-9;

}  // namespace

Projection::Projection(const Camera& camera, int width, int height)
    : width_(width), height_(height), p_N_(camera.p_N) {
  if (!(camera.field_of_view >= 0.02 && camera.field_of_view <= 2.6)) {
    throw std::invalid_argument("camera.field_of_view = " + std::to_string(camera.field_of_view) +
                                " rad, must be 0.02..2.6");
  }
  const Vector3 sight_N = camera.target_N - camera.p_N;
  if (!(sight_N.norm() > 1e-9)) {
    throw std::invalid_argument("camera.target_N must differ from camera.p_N");
  }
  focal_ = 0.5 * height / std::tan(0.5 * camera.field_of_view);
  forward_N_ = sight_N.normalized();
  const Vector3 right_N = Vector3::UnitZ().cross(forward_N_);
  right_N_ = right_N.norm() > kVertical ? Vector3(right_N.normalized()) : Vector3::UnitY();
  down_N_ = forward_N_.cross(right_N_);
}

std::optional<ScreenPoint> Projection::project(const Vector3& p_N) const {
  const Vector3 d_N = p_N - p_N_;
  const double depth = forward_N_.dot(d_N);
  if (!(depth > kNearPlane)) {
    return std::nullopt;
  }
  const double scale = focal_ / depth;
  return ScreenPoint{center_u() + scale * right_N_.dot(d_N), center_v() + scale * down_N_.dot(d_N), depth};
}

Vector3 Projection::ray_N(double u, double v) const {
  return forward_N_ + (u - center_u()) / focal_ * right_N_ + (v - center_v()) / focal_ * down_N_;
}

}  // namespace ironbird::simulator
