#pragma once

#include <cstdint>
#include <variant>

#include "hil_bridge/can/serialisation.hpp"

// Parameters of a node, and what keeps them. See dronecan_messages.hpp.

namespace ironbird::hil_bridge::can {

/// Nothing, a whole number, a real one, a truth (0 or 1), a text.
using ParameterValue = std::variant<std::monostate, std::int64_t, float, std::uint8_t, BoundedText<128>>;
/// A bound: none, a whole number, a real one.
using ParameterBound = std::variant<std::monostate, std::int64_t, float>;
using ParameterName = BoundedText<92>;

/// Reads a parameter, or sets it when there is a value. A name wins over the index.
struct GetSetRequest {
  static constexpr DataType kType = {
      "uavcan.protocol.param.GetSet", {11, TransferKind::kRequest}, 0xA7B622F939D1A4D5};

  std::uint16_t index{};
  ParameterValue value{};
  ParameterName name{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("index", self.index, "1", "counted from 0", Bits{13});
    visit("value", self.value, "SI", "to set, empty to read");
    visit("name", self.name, "", "empty to go by the index");
  }
};

/// What the parameter is now. Without a name there is none.
struct GetSetResponse {
  static constexpr DataType kType = {
      "uavcan.protocol.param.GetSet", {11, TransferKind::kResponse}, GetSetRequest::kType.signature};

  ParameterValue value{};
  ParameterValue default_value{};
  ParameterBound max_value{};
  ParameterBound min_value{};
  ParameterName name{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("value", self.value, "SI", "now", Gap{5});
    visit("default_value", self.default_value, "SI", "after erasing", Gap{5});
    visit("max_value", self.max_value, "SI", "greatest allowed", Gap{6});
    visit("min_value", self.min_value, "SI", "least allowed", Gap{6});
    visit("name", self.name, "", "empty when there is none");
  }
};

/// Saves or erases the parameters.
struct ExecuteOpcodeRequest {
  static constexpr DataType kType = {
      "uavcan.protocol.param.ExecuteOpcode", {10, TransferKind::kRequest}, 0x3B131AC5EB69D2CD};
  static constexpr std::uint8_t kSave = 0;
  static constexpr std::uint8_t kErase = 1;

  std::uint8_t opcode{};
  std::int64_t argument{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("opcode", self.opcode, "1", "0 save, 1 erase");
    visit("argument", self.argument, "1", "0", Bits{48});
  }
};

/// Done, or not.
struct ExecuteOpcodeResponse {
  static constexpr DataType kType = {"uavcan.protocol.param.ExecuteOpcode",
                                     {10, TransferKind::kResponse},
                                     ExecuteOpcodeRequest::kType.signature};

  std::int64_t argument{};
  bool ok{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("argument", self.argument, "1", "0", Bits{48});
    visit("ok", self.ok, "1", "done");
  }
};

}  // namespace ironbird::hil_bridge::can
