#pragma once

#include <cstdint>
#include <vector>

#include "simulator/render/solid_layer.hpp"

namespace ironbird::simulator {

/// How much of the sun reaches the ground: a picture of the solids taken from the sun, looked up along the
/// sun's rays. Soft to half a texel and antialiased.
class ShadowMap {
 public:
  ShadowMap() = default;

  /// @param part    whose shadow
  /// @param center_N, radius  sphere that contains it, m
  /// @param size    texels per side
  ShadowMap(SolidLayer& solids, SolidPart part, const Vector3& center_N, double radius, int size);

  /// Adds the thin shadow of a spinning rotor. @param opacity  0..1
  void add_disc(const Vector3& center_N, const Vector3& axis_N, double radius, double opacity);

  bool empty() const { return size_ == 0; }

  /// Texel coordinates of the ground point (n, e): linear, so they advance evenly along a row of pixels.
  double u(double north, double east) const { return u_offset_ + u_north_ * north + u_east_ * east; }
  double v(double north, double east) const { return v_offset_ + v_north_ * north + v_east_ * east; }

  /// Share of the sun that is blocked at texel coordinates, bilinear, 0..1; 0 outside the map.
  float blocked(float u, float v) const;

  /// The ground point under texel coordinates.
  Vector3 ground_N(double u, double v) const;

  int size() const { return size_; }

 private:
  void soften();

  int size_ = 0;
  std::vector<std::uint8_t> coverage_;
  Vector3 center_N_ = Vector3::Zero();
  Vector3 sun_N_ = Vector3::Zero();
  Vector3 right_N_ = Vector3::Zero();
  Vector3 down_N_ = Vector3::Zero();
  double texel_ = 1.0;  ///< m
  double u_offset_ = 0.0;
  double u_north_ = 0.0;
  double u_east_ = 0.0;
  double v_offset_ = 0.0;
  double v_north_ = 0.0;
  double v_east_ = 0.0;
};

}  // namespace ironbird::simulator
