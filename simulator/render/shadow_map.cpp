#include "simulator/render/shadow_map.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {
namespace {

// The sun stands this many radii away: near enough to parallel light, far from the limits of the depth
// buffer.
constexpr double kSunDistance = 200.0;

}  // namespace

ShadowMap::ShadowMap(SolidLayer& solids, SolidPart part, const Vector3& center_N, double radius, int size)
    : size_(size), center_N_(center_N), sun_N_(solids.sun_N()) {
  Camera sun;
  sun.p_N = center_N + kSunDistance * radius * sun_N_;
  sun.target_N = center_N;
  sun.field_of_view = 0.02;
  // The narrowest lens sees kSunDistance * 0.02 / 2 = 2 radii; a picture twice as large, cut in the middle,
  // sees one.
  const Projection projection(sun, 2 * size, 2 * size);
  const PixelRect rect{size / 2, size / 2, size / 2 + size, size / 2 + size};
  const SolidPicture& picture = solids.draw(projection, rect, 1, part);
  texel_ = kSunDistance * radius / projection.focal();
  right_N_ = projection.right_N();
  down_N_ = projection.down_N();
  coverage_.resize(static_cast<std::size_t>(size * size));
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const auto from = static_cast<std::size_t>((size - 1 - y) * size + x);
      coverage_[static_cast<std::size_t>(y * size + x)] = picture.window_depth[from] < 1.0F ? 255 : 0;
    }
  }
  soften();
  const Vector3 u_axis = right_N_ / texel_;
  const Vector3 v_axis = down_N_ / texel_;
  u_north_ = u_axis.x();
  u_east_ = u_axis.y();
  u_offset_ = 0.5 * size - u_axis.dot(center_N);
  v_north_ = v_axis.x();
  v_east_ = v_axis.y();
  v_offset_ = 0.5 * size - v_axis.dot(center_N);
}

void ShadowMap::soften() {
  const std::vector<std::uint8_t> sharp = coverage_;
  for (int y = 1; y + 1 < size_; ++y) {
    for (int x = 1; x + 1 < size_; ++x) {
      const auto at = static_cast<std::size_t>(y * size_ + x);
      const auto row = static_cast<std::size_t>(size_);
      const int sum = 4 * sharp[at] +
                      2 * (sharp[at - 1] + sharp[at + 1] + sharp[at - row] + sharp[at + row]) +
                      sharp[at - row - 1] + sharp[at - row + 1] + sharp[at + row - 1] + sharp[at + row + 1];
      coverage_[at] = static_cast<std::uint8_t>(sum / 16);
    }
  }
}

void ShadowMap::add_disc(const Vector3& center_N, const Vector3& axis_N, double radius, double opacity) {
  const double facing = axis_N.dot(sun_N_);
  if (std::abs(facing) < 0.05) {
    return;
  }
  for (int y = 0; y < size_; ++y) {
    for (int x = 0; x < size_; ++x) {
      const Vector3 on_plane_N = center_N_ + (x + 0.5 - 0.5 * size_) * texel_ * right_N_ +
                                 (y + 0.5 - 0.5 * size_) * texel_ * down_N_;
      // Along the sun's ray to the plane of the disc.
      const double along = axis_N.dot(center_N - on_plane_N) / facing;
      if ((on_plane_N + along * sun_N_ - center_N).squaredNorm() < radius * radius) {
        std::uint8_t& texel = coverage_[static_cast<std::size_t>(y * size_ + x)];
        texel = static_cast<std::uint8_t>(texel + (255 - texel) * opacity);
      }
    }
  }
}

float ShadowMap::blocked(float u, float v) const {
  const float x = u - 0.5F;
  const float y = v - 0.5F;
  if (!(x >= 0.0F && y >= 0.0F && x < static_cast<float>(size_ - 1) && y < static_cast<float>(size_ - 1))) {
    return 0.0F;
  }
  const int i = static_cast<int>(x);
  const int j = static_cast<int>(y);
  const float fx = x - static_cast<float>(i);
  const float fy = y - static_cast<float>(j);
  const std::uint8_t* at = coverage_.data() + j * size_ + i;
  const float upper = static_cast<float>(at[0]) + fx * static_cast<float>(at[1] - at[0]);
  const float lower = static_cast<float>(at[size_]) + fx * static_cast<float>(at[size_ + 1] - at[size_]);
  return (upper + fy * (lower - upper)) * (1.0F / 255.0F);
}

Vector3 ShadowMap::ground_N(double u, double v) const {
  const Vector3 on_plane_N =
      center_N_ + (u - 0.5 * size_) * texel_ * right_N_ + (v - 0.5 * size_) * texel_ * down_N_;
  return on_plane_N - on_plane_N.z() / sun_N_.z() * sun_N_;
}

}  // namespace ironbird::simulator
