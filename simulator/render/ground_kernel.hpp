#pragma once

#include <array>
#include <utility>

#include "simulator/render/image.hpp"

namespace ironbird::simulator {

/// One row of the ground: what changes from row to row, ready for the inner loop. Lengths in m, colours
/// 0..255.
struct GroundRow {
  float north = 0.0F;  ///< of the first pixel, > 0 throughout the row, from a multiple of ten metres
  float north_step = 0.0F;
  float north_print = 1.0F;  ///< extent of one pixel along north
  float east = 0.0F;
  float east_step = 0.0F;
  float east_print = 1.0F;
  float fine_lines = 0.0F;    ///< opacity of the one-metre grid
  float strong_lines = 0.0F;  ///< opacity of the ten-metre grid
  float squares = 0.0F;       ///< contrast of the squares of five metres
  std::array<float, 3> base{};
  std::array<float, 3> square{};  ///< added or taken away in alternating squares
  std::array<float, 3> line{};    ///< added where a line covers the pixel

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("north", self.north, "m", "of the first pixel");
    visit("north_step", self.north_step, "m", "from pixel to pixel");
    visit("north_print", self.north_print, "m", "extent of one pixel");
    visit("east", self.east, "m", "of the first pixel");
    visit("east_step", self.east_step, "m", "from pixel to pixel");
    visit("east_print", self.east_print, "m", "extent of one pixel");
    visit("fine_lines", self.fine_lines, "1", "opacity of the one-metre grid", 0.0, 1.0);
    visit("strong_lines", self.strong_lines, "1", "opacity of the ten-metre grid", 0.0, 1.0);
    visit("squares", self.squares, "1", "contrast of the squares", 0.0, 1.0);
    visit("base", self.base, "1", "colour of the ground, 0..255");
    visit("square", self.square, "1", "added or taken away in alternating squares");
    visit("line", self.line, "1", "added where a line covers the pixel");
  }
};

/// Draws a row. The same bytes with any vector width: no operation is fused or reordered.
void draw_ground(const GroundRow& row, Pixel* pixels, int width);

/// The pixels [first, last) of a row of `width` whose linear coordinates a + a_step*x and b + b_step*x both
/// lie within +-half.
std::pair<int, int> row_range(double a, double a_step, double b, double b_step, double half, int width);

}  // namespace ironbird::simulator
