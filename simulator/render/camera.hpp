#pragma once

#include <optional>

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Where one looks from and at. A camera stands upright: its image rows are horizontal. Looking straight
/// down, north is at the top of the picture.
struct Camera {
  Vector3 p_N = Vector3(-4.0, 0.0, -2.0);
  Vector3 target_N = Vector3::Zero();
  double field_of_view = 0.8;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position from the local origin");
    visit("target_N", self.target_N, "m", "point in the middle of the picture");
    visit("field_of_view", self.field_of_view, "rad", "angle from the lower to the upper edge", 0.02, 2.6);
  }
};

/// Where a point of N appears: pixels from the upper left corner, and its distance along the line of sight.
struct ScreenPoint {
  double u = 0.0;
  double v = 0.0;
  double depth = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("u", self.u, "px", "from the left edge; 0.5 is the middle of the first pixel");
    visit("v", self.v, "px", "from the upper edge");
    visit("depth", self.depth, "m", "along the optical axis");
  }
};

/// The pinhole projection of a camera onto a picture of given size. Square pixels, no distortion.
class Projection {
 public:
  /// @param width, height  px, > 0
  /// @throws std::invalid_argument when the camera stands in its own target or its field of view is out of
  /// bounds
  Projection(const Camera& camera, int width, int height);

  /// The picture of a point, or nothing when it lies behind the nearest visible plane.
  std::optional<ScreenPoint> project(const Vector3& p_N) const;

  /// Direction of the line of sight through (u, v), scaled to one metre of depth.
  Vector3 ray_N(double u, double v) const;

  int width() const { return width_; }
  int height() const { return height_; }
  double center_u() const { return 0.5 * width_; }
  double center_v() const { return 0.5 * height_; }
  double focal() const { return focal_; }  ///< px
  const Vector3& p_N() const { return p_N_; }
  const Vector3& forward_N() const { return forward_N_; }
  const Vector3& right_N() const { return right_N_; }  ///< horizontal
  const Vector3& down_N() const { return down_N_; }    ///< of the picture

 private:
  int width_;
  int height_;
  double focal_;
  Vector3 p_N_;
  Vector3 forward_N_;
  Vector3 right_N_;
  Vector3 down_N_;
};

/// Nothing nearer than this to the camera is drawn, m.
inline constexpr double kNearPlane = 0.05;

}  // namespace ironbird::simulator
