#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ironbird::simulator {

/// One pixel, 8 bits per channel, gamma-encoded as in sRGB. The fourth byte is opacity; a finished image is
/// opaque.
struct Pixel {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  std::uint8_t a = 255;

  friend bool operator==(const Pixel&, const Pixel&) = default;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("r", self.r, "1", "red, 0..255");
    visit("g", self.g, "1", "green, 0..255");
    visit("b", self.b, "1", "blue, 0..255");
    visit("a", self.a, "1", "opacity, 0..255");
  }
};

/// A picture in memory: rows from the top, pixels from the left.
class Image {
 public:
  Image() = default;
  /// @param width, height  pixels, >= 0
  Image(int width, int height, Pixel fill = {})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

  int width() const { return width_; }
  int height() const { return height_; }

  /// The row `y`, 0 <= y < height, as `width` pixels.
  Pixel* row(int y) { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  const Pixel* row(int y) const { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }

  Pixel& at(int x, int y) { return row(y)[x]; }
  const Pixel& at(int x, int y) const { return row(y)[x]; }

  const std::vector<Pixel>& pixels() const { return pixels_; }

  friend bool operator==(const Image&, const Image&) = default;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace ironbird::simulator
