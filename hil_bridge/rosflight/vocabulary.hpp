#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>

// What the numbers in messages mean, and how a text lies in a field. See messages.hpp.

namespace ironbird::hil_bridge::rosflight {

/// In every HEARTBEAT of this dialect.
inline constexpr std::uint8_t kDialectVersion = 2;

/// Parameters of every ROSflight 2.0 unit.
inline constexpr int kParameterCount = 333;

/// No unit has been on for longer. What claims to be is a broken stamp, and is held here, where sums and
/// differences of stamps still have room.
inline constexpr std::chrono::nanoseconds kGreatestClock = std::chrono::hours(24 * 365 * 10);

/// A unit's clock as it stands in its messages.
constexpr std::chrono::nanoseconds clock_of(std::uint64_t us) {
  constexpr auto kMost = static_cast<std::uint64_t>(kGreatestClock.count() / 1000);
  return std::chrono::microseconds(std::min(us, kMost));
}

/// The two kinds of parameter.
enum class ParameterType : std::uint8_t { kInteger = 6, kReal = 9 };

/// What ROSFLIGHT_CMD can ask for.
enum Command : std::uint8_t {
  kCalibrateRc = 0,
  kCalibrateImu = 1,
  kCalibrateGyro = 2,
  kCalibrateBaro = 3,
  kCalibrateAirspeed = 4,
  kReadParameters = 5,
  kWriteParameters = 6,
  kDefaultParameters = 7,
  kReboot = 8,
  kRebootToBootloader = 9,
  kSendVersion = 10,
  kResetOrigin = 11,        ///< known and refused
  kSendAllConfigInfos = 12  ///< known and refused
};

/// Bits of the error code in ROSFLIGHT_STATUS.
enum ErrorBit : std::uint16_t {
  kInvalidMixer = 0x01,
  kImuNotResponding = 0x02,
  kErrorRcLost = 0x04,
  kUnhealthyEstimator = 0x08,
  kTimeGoingBackwards = 0x10,
  kUncalibratedImu = 0x20,
  kBufferOverrun = 0x40,
  kInvalidFailsafe = 0x80
};

/// Bits of rc_override in ROSFLIGHT_STATUS: which axes the pilot holds, and why.
enum OverrideBit : std::uint16_t {
  kAttitudeSwitch = 0x001,
  kThrottleSwitch = 0x002,
  kRollStick = 0x004,
  kPitchStick = 0x008,
  kYawStick = 0x010,
  kMinimumThrottle = 0x020,
  kRollInactive = 0x040,
  kPitchInactive = 0x080,
  kYawInactive = 0x100,
  kThrottleInactive = 0x200
};

/// The text in a field: up to the first zero, or all of it when there is none.
template <std::size_t N>
constexpr std::string_view text_of(const std::array<char, N>& field) {
  const auto end = std::find(field.begin(), field.end(), '\0');
  return {field.data(), static_cast<std::size_t>(end - field.begin())};
}
template <std::size_t N>
constexpr std::string_view text_of(const std::array<char, N>&&) = delete;  // the text would outlive its field

/// A field with this text, zero padded. What is too long is cut off.
template <std::size_t N>
constexpr std::array<char, N> field_of(std::string_view text) {
  std::array<char, N> field{};
  std::copy_n(text.begin(), std::min(text.size(), N), field.begin());
  return field;
}

/// What a unit says ends up on terminals and in files: bytes that are no printable ASCII become question
/// marks.
template <std::size_t N>
constexpr void make_printable(std::array<char, N>& field) {
  constexpr char kFirst = ' ';
  constexpr char kLast = '~';
  const auto end = std::find(field.begin(), field.end(), '\0');
  std::replace_if(
      field.begin(), end, [](char c) { return c < kFirst || c > kLast; }, '?');
}

}  // namespace ironbird::hil_bridge::rosflight
