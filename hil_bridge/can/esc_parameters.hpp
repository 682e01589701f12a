#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hil_bridge/can/parameter_messages.hpp"

namespace ironbird::hil_bridge::can {

/// The parameters of an ESC node, in the order of their index.
enum class EscParameter : std::uint8_t { kEscIndex, kStatusRate, kCommandTimeout, kRequireArming };

/// One row of the table: what a parameter can be.
struct EscParameterInfo {
  std::string_view name;
  std::int64_t least = 0;
  std::int64_t greatest = 0;
  bool truth = false;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "on the wire");
    visit("least", self.least, "SI", "allowed");
    visit("greatest", self.greatest, "SI", "allowed");
    visit("truth", self.truth, "1", "yes or no instead of a number");
  }
};

inline constexpr std::array<EscParameterInfo, 4> kEscParameters = {{{"ESC_INDEX", 0, 19, false},
                                                                    {"STATUS_RATE_HZ", 10, 50, false},
                                                                    {"CMD_TIMEOUT_MS", 20, 1000, false},
                                                                    {"REQUIRE_ARMING", 0, 1, true}}};

/// What an ESC node remembers: the values in force, and those that it would start with. Refuses, by answering
/// with the value as it was, what is out of bounds or of another kind.
class EscParameters {
 public:
  using Values = std::array<std::int64_t, kEscParameters.size()>;

  /// @param defaults  within their bounds
  explicit EscParameters(const Values& defaults) : defaults_(defaults), saved_(defaults), values_(defaults) {}

  std::int64_t operator[](EscParameter parameter) const {
    return values_[static_cast<std::size_t>(parameter)];
  }

  GetSetResponse get_set(const GetSetRequest& request);
  ExecuteOpcodeResponse execute(const ExecuteOpcodeRequest& request);

  /// Forgets what was not saved, as a restart does.
  void restart() { values_ = saved_; }

 private:
  Values defaults_;
  Values saved_;
  Values values_;
};

}  // namespace ironbird::hil_bridge::can
