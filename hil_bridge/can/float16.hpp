#pragma once

#include <bit>
#include <cstdint>

// IEEE 754 numbers of 16 bits, as bits.

namespace ironbird::hil_bridge::can {

/// The number that a 16-bit pattern means. Exact; a NaN keeps its payload.
constexpr float float_of(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000U) << 16U;
  const std::uint32_t exponent = half >> 10U & 0x1FU;
  const std::uint32_t fraction = half & 0x3FFU;
  if (exponent == 0x1F) return std::bit_cast<float>(sign | 0x7F800000U | fraction << 13U);
  if (exponent != 0) return std::bit_cast<float>(sign | (exponent + 112U) << 23U | fraction << 13U);
  const float magnitude = static_cast<float>(fraction) * 0x1.0p-24F;
  return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(magnitude));
}

/// The nearest 16-bit pattern, of two equally near ones the even. A number too great becomes the greatest
/// that there is, 65504; infinity stays infinite, a NaN a NaN.
constexpr std::uint16_t half_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16U & 0x8000U);
  const std::uint32_t magnitude = bits & 0x7FFFFFFFU;
  if (magnitude > 0x7F800000U) {
    const std::uint32_t payload = magnitude >> 13U & 0x3FFU;
    return static_cast<std::uint16_t>(sign | 0x7C00U | (payload == 0 ? 0x200U : payload));
  }
  if (magnitude == 0x7F800000U) return sign | 0x7C00U;
  constexpr std::uint32_t kGreatest = 0x477FE000U;        // 65504
  constexpr std::uint32_t kSmallestNormal = 113U << 23U;  // 2^-14
  if (magnitude >= kGreatest) return sign | 0x7BFFU;
  if (magnitude >= kSmallestNormal) {
    const std::uint32_t rounded = magnitude + 0xFFFU + (magnitude >> 13U & 1U);
    return static_cast<std::uint16_t>(sign | ((rounded >> 13U) - (112U << 10U)));
  }
  // Adding 0.5 leaves exactly the bits that count in steps of 2^-24, rounded by the addition.
  const float shifted = std::bit_cast<float>(magnitude) + 0.5F;
  return static_cast<std::uint16_t>(sign | (std::bit_cast<std::uint32_t>(shifted) - 0x3F000000U));
}

}  // namespace ironbird::hil_bridge::can
