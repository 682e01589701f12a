#include "scenarios/video/yuv.hpp"

#include <cassert>

namespace ironbird::scenarios {
namespace {

using simulator::Pixel;

// BT.709 in 256ths: 219 steps of brightness from 16, 224 of colour difference around 128.
constexpr int kYr = 47, kYg = 157, kYb = 16;
constexpr int kUr = -26, kUg = -86, kUb = 112;
constexpr int kVr = 112, kVg = -102, kVb = -10;

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx2", "default")))
#endif
void brightness_row(const Pixel* in, std::uint8_t* out, int width) {
  for (int x = 0; x < width; ++x) {
    out[x] = static_cast<std::uint8_t>(16 + ((kYr * in[x].r + kYg * in[x].g + kYb * in[x].b + 128) >> 8));
  }
}

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx2", "default")))
#endif
void color_row(const Pixel* upper, const Pixel* lower, std::uint8_t* u, std::uint8_t* v, int pairs) {
  for (int x = 0; x < pairs; ++x) {
    const int r = upper[2 * x].r + upper[2 * x + 1].r + lower[2 * x].r + lower[2 * x + 1].r;
    const int g = upper[2 * x].g + upper[2 * x + 1].g + lower[2 * x].g + lower[2 * x + 1].g;
    const int b = upper[2 * x].b + upper[2 * x + 1].b + lower[2 * x].b + lower[2 * x + 1].b;
    u[x] = static_cast<std::uint8_t>(128 + ((kUr * r + kUg * g + kUb * b + 512) >> 10));
    v[x] = static_cast<std::uint8_t>(128 + ((kVr * r + kVg * g + kVb * b + 512) >> 10));
  }
}

}  // namespace

void to_yuv420(const simulator::Image& image, std::span<std::uint8_t> out) {
  const int width = image.width();
  const int height = image.height();
  assert(width % 2 == 0 && height % 2 == 0 && out.size() == yuv420_size(width, height));
  const std::ptrdiff_t pixels = static_cast<std::ptrdiff_t>(width) * height;
  std::uint8_t* y_plane = out.data();
  std::uint8_t* u_plane = y_plane + pixels;
  std::uint8_t* v_plane = u_plane + pixels / 4;
  for (int y = 0; y < height; ++y) {
    brightness_row(image.row(y), y_plane + static_cast<std::ptrdiff_t>(y) * width, width);
  }
  for (int y = 0; y < height / 2; ++y) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * (width / 2);
    color_row(image.row(2 * y), image.row(2 * y + 1), u_plane + at, v_plane + at, width / 2);
  }
}

}  // namespace ironbird::scenarios
