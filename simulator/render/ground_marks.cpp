#include "simulator/render/ground_marks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ironbird::simulator {
namespace {

constexpr int kTexels = 512;
constexpr int kSubsamples = 3;  // per texel and axis while painting

using Paint = GroundMarks::Paint;

const Paint kConcrete(96.0F * 0.92F, 99.0F * 0.92F, 102.0F * 0.92F, 0.92F);
const Paint kWhite(238.0F, 240.0F, 240.0F, 1.0F);
const Paint kYellow(247.0F, 190.0F, 40.0F, 1.0F);
const Paint kRed(226.0F, 66.0F, 36.0F, 1.0F);

// x east, y north, in radii of the pad.
Paint helipad_paint(double x, double y) {
  const double r = std::sqrt(x * x + y * y);
  if (r > 1.0) {
    return Paint::Zero();
  }
  if (r > 0.86 && r < 0.95) {
    return kYellow;
  }
  const bool upright = std::abs(std::abs(x) - 0.30) < 0.075 && std::abs(y) < 0.48;
  const bool bar = std::abs(x) < 0.30 && std::abs(y) < 0.075;
  return upright || bar ? kWhite : kConcrete;
}

double glyph_coverage(const GlyphAtlas& letters, char letter, double x, double y) {
  const GlyphAtlas::Glyph& glyph = letters.glyph(letter);
  const int column = static_cast<int>(std::floor(x + letters.left_bearing() + 0.5 * glyph.advance));
  const int row = static_cast<int>(std::floor(y + letters.baseline() - 0.5 * letters.cap_height()));
  if (column < 0 || row < 0 || column >= glyph.width || row >= letters.height()) {
    return 0.0;
  }
  return glyph.coverage[static_cast<std::size_t>(row * glyph.width + column)] / 255.0;
}

Paint faded(const Paint& paint, double opacity) {
  return paint * static_cast<float>(opacity);
}

// x east, y north, in radii of the rose.
Paint rose_paint(double x, double y, const GlyphAtlas& letters) {
  const double r = std::sqrt(x * x + y * y);
  if (std::abs(r - 0.985) < 0.012) {
    return faded(kWhite, 0.8);
  }
  if (r < 0.985 && r > 0.89) {
    const double bearing = std::atan2(x, y);
    const double tick = std::remainder(bearing, std::numbers::pi / 18.0) * r;
    const bool long_tick = std::abs(std::remainder(bearing, std::numbers::pi / 6.0) * r) < 0.011;
    if ((std::abs(tick) < 0.006 && r > 0.935) || long_tick) {
      return faded(kWhite, 0.8);
    }
  }
  struct Letter {
    char glyph;
    double east;
    double north;
  };
  constexpr std::array<Letter, 4> kLetters{
      {{'N', 0.0, 0.72}, {'E', 0.72, 0.0}, {'S', 0.0, -0.72}, {'W', -0.72, 0.0}}};
  const double texels = letters.cap_height() / 0.20;  // letters a fifth of the radius high
  for (const Letter& letter : kLetters) {
    const double ink =
        glyph_coverage(letters, letter.glyph, (x - letter.east) * texels, -(y - letter.north) * texels);
    if (ink > 0.0) {
      return faded(letter.glyph == 'N' ? kRed : kWhite, ink);
    }
  }
  // The arrow at north, outside the ring of letters.
  if (y > 1.0 && y < 1.18 && std::abs(x) < 0.45 * (1.18 - y)) {
    return kRed;
  }
  return Paint::Zero();
}

}  // namespace

GroundMarks::GroundMarks(const GroundMark& helipad, const GroundMark& compass_rose, const GlyphAtlas& letters)
    : center_N_(helipad.radius > 0.0 ? helipad.p_N : compass_rose.p_N),
      half_size_(1.2 * std::max(helipad.radius, compass_rose.radius)) {
  if (half_size_ == 0.0) {
    return;
  }
  Level full{kTexels, std::vector<Paint>(static_cast<std::size_t>(kTexels * kTexels), Paint::Zero())};
  const double step = 2.0 * half_size_ / (kTexels * kSubsamples);
  for (int j = 0; j < kTexels * kSubsamples; ++j) {
    for (int i = 0; i < kTexels * kSubsamples; ++i) {
      const double east = (i + 0.5) * step - half_size_;
      const double north = half_size_ - (j + 0.5) * step;
      Paint paint = Paint::Zero();
      if (helipad.radius > 0.0) {
        paint = helipad_paint(east / helipad.radius, north / helipad.radius);
      }
      if (paint[3] == 0.0F && compass_rose.radius > 0.0) {
        paint = rose_paint(east / compass_rose.radius, north / compass_rose.radius, letters);
      }
      Paint& texel = full.paint[static_cast<std::size_t>(j / kSubsamples * kTexels + i / kSubsamples)];
      texel += faded(paint, 1.0 / (kSubsamples * kSubsamples));
    }
  }
  levels_.push_back(std::move(full));
  while (levels_.back().size > 1) {
    const Level& fine = levels_.back();
    Level coarse{fine.size / 2, {}};
    for (int j = 0; j < coarse.size; ++j) {
      for (int i = 0; i < coarse.size; ++i) {
        const Paint* at = fine.paint.data() + 2 * j * fine.size + 2 * i;
        coarse.paint.push_back(faded(at[0] + at[1] + at[fine.size] + at[fine.size + 1], 0.25));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

GroundMarks::Sampler GroundMarks::sampler(float footprint) const {
  const float texels = footprint * static_cast<float>(kTexels / (2.0 * half_size_));
  std::size_t index = 0;
  for (float span = 1.5F; texels > span && index + 1 < levels_.size(); span *= 2.0F) {
    ++index;
  }
  const Level& level = levels_[index];
  const double scale = level.size / (2.0 * half_size_);
  Sampler sampler;
  sampler.texels_ = level.paint.data();
  sampler.size_ = level.size;
  sampler.scale_ = static_cast<float>(scale);
  sampler.east_offset_ = static_cast<float>(-(center_N_.y() - half_size_) * scale - 0.5);
  sampler.north_offset_ = static_cast<float>((center_N_.x() + half_size_) * scale - 0.5);
  return sampler;
}

}  // namespace ironbird::simulator
