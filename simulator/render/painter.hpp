#pragma once

#include <string_view>
#include <vector>

#include "simulator/render/camera.hpp"
#include "simulator/render/glyph_atlas.hpp"
#include "simulator/render/image.hpp"

namespace ironbird::simulator {

/// Distance of the nearest solid thing in each pixel along the optical axis, m; very large where there is
/// none.
struct DepthImage {
  int width = 0;
  std::vector<float> depth;

  float at(int x, int y) const {
    return depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("width", self.width, "px", "pixels per row");
    visit("depth", self.depth, "m", "rows from the top");
  }
};

/// Antialiased drawing into a picture with knowledge of what stands in front. Points and lengths of NED data
/// are projected; widths are pixels. What is behind a solid thing shows faintly.
class Painter {
 public:
  Painter(Image& image, const DepthImage& depth, const Projection& projection);

  /// A straight piece from `a_N` to `b_N`.
  void line(const Vector3& a_N, const Vector3& b_N, double width, Pixel color, double opacity);

  /// A path with round joints; with `dash`, m, > 0: dashed.
  void path(const std::vector<Vector3>& points_N, double width, Pixel color, double opacity, double dash);

  /// A horizontal ring in the air or on the ground.
  void ring(const Vector3& center_N, double radius, double width, Pixel color, double opacity);

  /// A round plate that faces the camera, with a rim and a text in it.
  /// @param opacity  of plate and text
  void plate(const Vector3& center_N, double radius_px, Pixel fill, Pixel rim, double opacity,
             std::string_view label, const GlyphAtlas& letters);

  /// A ring of constant size in the picture, in front of everything.
  void halo(const Vector3& center_N, double radius_px, double width, Pixel color, double opacity);

  /// A spinning rotor: a translucent disc with the streaks of its two blades.
  void rotor(const Vector3& center_N, const Vector3& axis_N, const Vector3& blade_N, double radius);

  /// @param left, baseline  px
  /// @param depth  m, where the text stands; 0: in front of everything
  /// @param opacity  0..1
  void text(int left, int baseline, std::string_view text, Pixel color, const GlyphAtlas& letters,
            double depth = 0.0, double opacity = 1.0);

  /// Darkens a rectangle.
  void shade(int left, int top, int right, int bottom, double opacity);

 private:
  void segment(double au, double av, double ad, double bu, double bv, double bd, double width, Pixel color,
               double opacity);

  Image& image_;
  const DepthImage& depth_;
  const Projection& projection_;
};

}  // namespace ironbird::simulator
