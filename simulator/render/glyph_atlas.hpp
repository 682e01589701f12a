#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "simulator/render/solid_layer.hpp"

namespace ironbird::simulator {

/// The printable ASCII characters as antialiased coverage masks of one height, made from the engine's large
/// typeface.
class GlyphAtlas {
 public:
  struct Glyph {
    int width = 0;                       ///< px of the mask
    int advance = 0;                     ///< px to the next character
    std::vector<std::uint8_t> coverage;  ///< rows from the top, `height()` of them
  };

  /// @param cap_height  of a capital letter, px, 4..40
  GlyphAtlas(SolidLayer& solids, int cap_height);

  /// The character's mask; a question mark's for what is not printable ASCII.
  const Glyph& glyph(char character) const;
  int height() const { return height_; }
  int left_bearing() const { return bearing_; }   ///< px of the mask left of the pen
  int baseline() const { return baseline_; }      ///< px from the top of a mask
  int cap_height() const { return cap_height_; }  ///< px
  int text_width(std::string_view text) const;    ///< px

 private:
  std::array<Glyph, 95> glyphs_;
  int height_ = 0;
  int bearing_ = 0;
  int baseline_ = 0;
  int cap_height_ = 0;
};

}  // namespace ironbird::simulator
