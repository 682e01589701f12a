#pragma once

#include <array>
#include <vector>

#include "simulator/render/camera.hpp"
#include "simulator/render/ground_marks.hpp"
#include "simulator/render/image.hpp"
#include "simulator/render/shadow_map.hpp"

namespace ironbird::simulator {

/// Sky, hills and ground, computed pixel by pixel with exact area filters, so that the grid neither flickers
/// nor needs supersampling. An upright camera sees each row of the ground at one depth: along a row
/// everything is linear.
///
/// The grid has a thin line every metre and a strong one every ten; the meadow alternates in squares of five.
class Backdrop {
 public:
  /// @param ground_color  red, green, blue, 0..1
  /// @param quick_marks  one look at the marks for every second pixel, instead of up to three for each that
  /// sees them aslant: they blur along the line of sight
  Backdrop(const Vector3& ground_color, GroundMarks marks, bool quick_marks);

  /// Fills the picture.
  /// @param shadows  applied one after the other
  void draw(const Projection& projection, const std::vector<const ShadowMap*>& shadows, Image& image) const;

 private:
  struct Row;
  void draw_sky(const Projection& projection, int horizon, Image& image) const;
  void draw_ground_row(const Row& row, Pixel* pixels, int width) const;
  void paint_marks(const Row& row, Pixel* pixels, int width) const;
  static void shade(const Row& row, const ShadowMap& shadow, Pixel* pixels, int width);

  Vector3 ground_color_;
  GroundMarks marks_;
  bool quick_marks_;
};

}  // namespace ironbird::simulator
