#pragma once

#include <array>
#include <cstdint>

// Parameters, asked for, told and set. See messages.hpp.

namespace ironbird::hil_bridge::rosflight {

/// The 32 bits of an int32 or a float32, as the kind beside them says. "float" to the dialect; never to be
/// computed with, because an integer's bits may be those of a NaN.
struct FloatBits {
  std::uint32_t bits{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("bits", self.bits, "1", "bits of an int32 or a float32");
  }
};

/// Asks for one parameter, by index or, with a negative index, by name.
struct ParamRequestRead {
  static constexpr std::uint8_t kId = 20;
  static constexpr const char* kName = "PARAM_REQUEST_READ";

  std::int16_t param_index{};
  std::uint8_t target_system{};
  std::uint8_t target_component{};
  std::array<char, 16> param_id{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("param_index", self.param_index, "1", "index, or negative: by name");
    visit("target_system", self.target_system, "1", "SYS_ID of the FCU");
    visit("target_component", self.target_component, "1", "ignored");
    visit("param_id", self.param_id, "", "name, zero padded, unterminated when 16 long");
  }
};

/// Asks for all parameters.
struct ParamRequestList {
  static constexpr std::uint8_t kId = 21;
  static constexpr const char* kName = "PARAM_REQUEST_LIST";

  std::uint8_t target_system{};
  std::uint8_t target_component{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("target_system", self.target_system, "1", "SYS_ID of the FCU");
    visit("target_component", self.target_component, "1", "ignored");
  }
};

/// One parameter.
struct ParamValue {
  static constexpr std::uint8_t kId = 22;
  static constexpr const char* kName = "PARAM_VALUE";

  FloatBits param_value{};
  std::uint16_t param_count{};
  std::uint16_t param_index{};
  std::array<char, 16> param_id{};
  std::uint8_t param_type{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("param_value", self.param_value, "1", "bits of an int32 or a float32");
    visit("param_count", self.param_count, "1", "how many parameters there are");
    visit("param_index", self.param_index, "1", "index of this one");
    visit("param_id", self.param_id, "", "name, zero padded, unterminated when 16 long");
    visit("param_type", self.param_type, "1", "6 int32, 9 float32");
  }
};

/// Sets one parameter.
struct ParamSet {
  static constexpr std::uint8_t kId = 23;
  static constexpr const char* kName = "PARAM_SET";

  FloatBits param_value{};
  std::uint8_t target_system{};
  std::uint8_t target_component{};
  std::array<char, 16> param_id{};
  std::uint8_t param_type{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("param_value", self.param_value, "1", "bits of an int32 or a float32");
    visit("target_system", self.target_system, "1", "SYS_ID of the FCU");
    visit("target_component", self.target_component, "1", "ignored");
    visit("param_id", self.param_id, "", "name, zero padded, unterminated when 16 long");
    visit("param_type", self.param_type, "1", "6 int32, 9 float32");
  }
};

}  // namespace ironbird::hil_bridge::rosflight
