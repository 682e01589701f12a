#include "simulator/render/ground_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace ironbird::simulator {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are written as words, red lowest");

constexpr float kFineWidth = 0.025F;   // of the one-metre grid, m
constexpr float kStrongWidth = 0.09F;  // of the ten-metre grid, m

inline float fraction(float x) {  // x >= 0
  return x - static_cast<float>(static_cast<std::int32_t>(x));
}

// Integral from 0 to x of a comb with teeth of `width` at the start of every unit; x >= 0.
inline float comb_integral(float x, float width) {
  const float whole = static_cast<float>(static_cast<std::int32_t>(x));
  const float rest = x - whole;
  return whole * width + (rest < width ? rest : width);
}

// Share of [x - print/2, x + print/2] that lies on lines of `width` at every multiple of 1 / per_period;
// per_print is the reciprocal of print * per_period.
inline float on_line(float x, float print, float per_print, float per_period, float width) {
  const float scaled = x * per_period + 0.5F * width * per_period;
  const float half = 0.5F * print * per_period;
  const float teeth = width * per_period;
  return (comb_integral(scaled + half, teeth) - comb_integral(scaled - half, teeth)) * per_print;
}

// Mean over the print, 2 half = 1 / per_print, of a square wave that is +1 on even and -1 on odd units; x >=
// 0.
inline float wave(float x, float half, float per_print) {
  const float upper = fraction(0.5F * (x + half)) * 2.0F - 1.0F;
  const float lower = fraction(0.5F * (x - half)) * 2.0F - 1.0F;
  const float rise = (1.0F - std::abs(upper)) - (1.0F - std::abs(lower));
  return rise * per_print;
}

}  // namespace

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx2", "default")))
#endif
void draw_ground(const GroundRow& row, Pixel* pixels, int width) {
  const GroundRow r = row;
  const float per_north = 1.0F / r.north_print;
  const float per_east = 1.0F / r.east_print;
  using Word = std::uint32_t __attribute__((may_alias));
  auto* words = reinterpret_cast<Word*>(pixels);
  for (std::int32_t i = 0; i < width; ++i) {
    const float x = static_cast<float>(i);
    const float north = r.north + r.north_step * x;
    const float east = r.east + r.east_step * x;
    const float fine_n = on_line(north, r.north_print, per_north, 1.0F, kFineWidth);
    const float fine_e = on_line(east, r.east_print, per_east, 1.0F, kFineWidth);
    const float strong_n = on_line(north, r.north_print, 10.0F * per_north, 0.1F, kStrongWidth);
    const float strong_e = on_line(east, r.east_print, 10.0F * per_east, 0.1F, kStrongWidth);
    const float fine = r.fine_lines * (fine_n + fine_e - fine_n * fine_e);
    const float strong = r.strong_lines * (strong_n + strong_e - strong_n * strong_e);
    const float line = fine + strong - fine * strong;
    const float square = r.squares * wave(0.2F * north, 0.1F * r.north_print, 5.0F * per_north) *
                         wave(0.2F * east, 0.1F * r.east_print, 5.0F * per_east);
    const float red = r.base[0] + r.square[0] * square + r.line[0] * line;
    const float green = r.base[1] + r.square[1] * square + r.line[1] * line;
    const float blue = r.base[2] + r.square[2] * square + r.line[2] * line;
    const auto rr = static_cast<std::uint32_t>(static_cast<std::int32_t>(red + 0.5F));
    const auto gg = static_cast<std::uint32_t>(static_cast<std::int32_t>(green + 0.5F));
    const auto bb = static_cast<std::uint32_t>(static_cast<std::int32_t>(blue + 0.5F));
    words[i] = rr | (gg << 8) | (bb << 16) | 0xff000000U;
  }
}

std::pair<int, int> row_range(double a, double a_step, double b, double b_step, double half, int width) {
  double first = 0.0;
  double last = width;
  for (const auto& [start, step] : {std::pair{a, a_step}, std::pair{b, b_step}}) {
    if (std::abs(step) < 1e-12) {
      if (std::abs(start) > half) {
        return {0, 0};
      }
      continue;
    }
    const double one = (-half - start) / step;
    const double other = (half - start) / step;
    first = std::max(first, std::min(one, other));
    last = std::min(last, std::max(one, other));
  }
  return first < last ? std::pair{static_cast<int>(std::ceil(first)), static_cast<int>(std::ceil(last))}
                      : std::pair{0, 0};
}

}  // namespace ironbird::simulator
