#include "simulator/render/glyph_atlas.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {
namespace {

// Rows of the first and last ink of a glyph.
std::array<int, 2> ink_rows(const SolidLayer::RawGlyph& raw) {
  std::array<int, 2> rows{raw.height, -1};
  for (int y = 0; y < raw.height; ++y) {
    for (int x = 0; x < raw.width; ++x) {
      if (raw.coverage[static_cast<std::size_t>(y * raw.width + x)] > 127) {
        rows[0] = std::min(rows[0], y);
        rows[1] = std::max(rows[1], y);
      }
    }
  }
  return rows;
}

// Mean of the raw coverage over a rectangle with fractional edges.
double mean_coverage(const SolidLayer::RawGlyph& raw, double left, double top, double step) {
  double sum = 0.0;
  for (int y = static_cast<int>(top); y < std::min(raw.height, static_cast<int>(std::ceil(top + step)));
       ++y) {
    const double rows = std::min(top + step, y + 1.0) - std::max(top, static_cast<double>(y));
    for (int x = static_cast<int>(left); x < std::min(raw.width, static_cast<int>(std::ceil(left + step)));
         ++x) {
      const double columns = std::min(left + step, x + 1.0) - std::max(left, static_cast<double>(x));
      sum += rows * columns * raw.coverage[static_cast<std::size_t>(y * raw.width + x)];
    }
  }
  return sum / (step * step);
}

}  // namespace

GlyphAtlas::GlyphAtlas(SolidLayer& solids, int cap_height) : cap_height_(cap_height) {
  const SolidLayer::RawGlyph capital = solids.glyph('H');
  const std::array<int, 2> ink = ink_rows(capital);
  const double step = static_cast<double>(ink[1] - ink[0] + 1) / cap_height;
  // Sampling starts so that the top of a capital falls on a whole row.
  const double top = ink[0] - std::floor(ink[0] / step) * step;
  height_ = static_cast<int>((capital.height - top) / step);
  bearing_ = static_cast<int>(std::lround(SolidLayer::kGlyphMargin / step));
  baseline_ = static_cast<int>(std::lround((ink[1] + 1 - top) / step));
  for (std::size_t i = 0; i < glyphs_.size(); ++i) {
    const SolidLayer::RawGlyph raw = solids.glyph(static_cast<char>(' ' + i));
    Glyph& glyph = glyphs_[i];
    glyph.width = static_cast<int>(std::ceil(raw.width / step));
    glyph.advance = static_cast<int>(std::lround((raw.width - 2 * SolidLayer::kGlyphMargin) / step));
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < glyph.width; ++x) {
        glyph.coverage.push_back(
            static_cast<std::uint8_t>(mean_coverage(raw, x * step, top + y * step, step)));
      }
    }
  }
}

const GlyphAtlas::Glyph& GlyphAtlas::glyph(char character) const {
  const bool printable = character >= ' ' && character <= '~';
  return glyphs_[static_cast<std::size_t>((printable ? character : '?') - ' ')];
}

int GlyphAtlas::text_width(std::string_view text) const {
  int width = 0;
  for (const char character : text) {
    width += glyph(character).advance;
  }
  return width;
}

}  // namespace ironbird::simulator
