#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "simulator/render/image.hpp"

namespace ironbird::scenarios {

/// Bytes of a picture as planar YUV 4:2:0; both sides even.
constexpr std::size_t yuv420_size(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3 / 2;
}

/// Converts to planar YUV 4:2:0, ITU-R BT.709, limited range, in integers. Colour is the mean of four pixels.
/// @param out  yuv420_size() bytes: brightness, then blue, then red difference
void to_yuv420(const simulator::Image& image, std::span<std::uint8_t> out);

}  // namespace ironbird::scenarios
