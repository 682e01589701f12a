#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "hil_bridge/rosflight/messages.hpp"

// What MAVLink needs to know of each message, computed from the messages' descriptions while compiling:
// payload length, place of each field, and the check byte by which two sides find out that they speak
// different dialects.

namespace ironbird::hil_bridge::rosflight {

/// One byte more of the link's checksum: CRC-16/MCRF4XX, reflected polynomial 0x8408, no final XOR.
constexpr std::uint16_t crc_of(std::uint16_t crc, std::uint8_t byte) {
  auto t = static_cast<std::uint8_t>(byte ^ (crc & 0xFFU));
  t = static_cast<std::uint8_t>(t ^ (t << 4U));
  return static_cast<std::uint16_t>((crc >> 8U) ^ (t << 8U) ^ (t << 3U) ^ (t >> 4U));
}
inline constexpr std::uint16_t kCrcStart = 0xFFFF;

/// One field of a payload.
struct WireField {
  std::string_view name;
  std::string_view type;    ///< the dialect's name of the element type
  std::uint8_t size = 0;    ///< of one element, bytes
  std::uint8_t count = 1;   ///< elements
  bool array = false;       ///< declared as an array
  std::uint8_t offset = 0;  ///< of the first byte in the payload

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "name in the dialect");
    visit("type", self.type, "", "the dialect's name of the element type");
    visit("size", self.size, "byte", "of one element");
    visit("count", self.count, "1", "elements");
    visit("array", self.array, "1", "declared as an array");
    visit("offset", self.offset, "byte", "of the first byte in the payload");
  }
};

namespace detail {

template <class T>
constexpr std::string_view wire_type() {
  if constexpr (std::is_same_v<T, char>) return "char";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8_t";
  if constexpr (std::is_same_v<T, std::int16_t>) return "int16_t";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "uint16_t";
  if constexpr (std::is_same_v<T, std::int32_t>) return "int32_t";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "uint32_t";
  if constexpr (std::is_same_v<T, std::int64_t>) return "int64_t";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "uint64_t";
  if constexpr (std::is_same_v<T, float> || std::is_same_v<T, FloatBits>) return "float";
  if constexpr (std::is_same_v<T, double>) return "double";
}

template <class T>
struct ElementOf {
  using Type = T;
  static constexpr std::uint8_t kCount = 1;
  static constexpr bool kArray = false;
};
template <class T, std::size_t N>
struct ElementOf<std::array<T, N>> {
  using Type = T;
  static constexpr std::uint8_t kCount = N;
  static constexpr bool kArray = true;
};

template <class M>
constexpr std::size_t field_count() {
  std::size_t count = 0;
  const M message{};
  M::describe(message, [&](const char*, const auto&, const char*, const char*) { ++count; });
  return count;
}

/// Fields in the order of the wire: the largest elements first, otherwise as described.
template <class M>
constexpr auto wire_fields() {
  std::array<WireField, field_count<M>()> fields{};
  std::size_t count = 0;
  const M message{};
  M::describe(message, [&](const char* name, const auto& member, const char*, const char*) {
    using Element = ElementOf<std::decay_t<decltype(member)>>;
    using Type = typename Element::Type;
    const WireField field = {name, wire_type<Type>(), sizeof(Type), Element::kCount, Element::kArray, 0};
    std::size_t place = count++;
    for (; place > 0 && fields[place - 1].size < field.size; --place) fields[place] = fields[place - 1];
    fields[place] = field;
  });
  std::uint8_t offset = 0;
  for (WireField& field : fields) {
    field.offset = offset;
    offset = static_cast<std::uint8_t>(offset + field.size * field.count);
  }
  return fields;
}

constexpr std::uint16_t crc_of(std::uint16_t crc, std::string_view text) {
  for (const char letter : text) crc = rosflight::crc_of(crc, static_cast<std::uint8_t>(letter));
  return rosflight::crc_of(crc, ' ');
}

template <class M>
constexpr std::uint8_t crc_extra() {
  std::uint16_t crc = crc_of(kCrcStart, std::string_view(M::kName));
  for (const WireField& field : wire_fields<M>()) {
    crc = crc_of(crc_of(crc, field.type), field.name);
    if (field.array) crc = rosflight::crc_of(crc, field.count);
  }
  return static_cast<std::uint8_t>((crc & 0xFFU) ^ (crc >> 8U));
}

}  // namespace detail

/// The fields of a message in the order of the wire, with their offsets.
template <class M>
inline constexpr auto kWireFields = detail::wire_fields<M>();

/// Bytes of a message's payload.
template <class M>
inline constexpr std::uint8_t kPayloadLength = static_cast<std::uint8_t>(kWireFields<M>.back().offset +
                                                                         kWireFields<M>.back().size *
                                                                             kWireFields<M>.back().count);

/// The byte that goes into the checksum of every frame and stands for name, types and order of the fields.
template <class M>
inline constexpr std::uint8_t kCrcExtra = detail::crc_extra<M>();

/// One line of the dialect.
struct MessageInfo {
  std::uint8_t id = 0;
  std::string_view name;
  std::uint8_t length = 0;
  std::uint8_t crc_extra = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("id", self.id, "1", "number on the wire");
    visit("name", self.name, "", "name in the dialect");
    visit("length", self.length, "byte", "of the payload");
    visit("crc_extra", self.crc_extra, "1", "stands for names and types in the checksum");
  }
};

namespace detail {

template <class... M>
constexpr std::array<MessageInfo, sizeof...(M)> dialect(std::type_identity<std::variant<M...>>) {
  return {{{M::kId, M::kName, kPayloadLength<M>, kCrcExtra<M>}...}};
}

/// Do the members stand in wire order? The codec goes through them as they are described.
template <class... M>
constexpr bool in_wire_order(std::type_identity<std::variant<M...>>) {
  const auto ordered = []<class One>(std::type_identity<One>) {
    std::uint8_t before = 8;
    bool descending = true;
    const One message{};
    One::describe(message, [&](const char*, const auto& member, const char*, const char*) {
      using Type = typename ElementOf<std::decay_t<decltype(member)>>::Type;
      descending = descending && sizeof(Type) <= before;
      before = sizeof(Type);
    });
    return descending;
  };
  return (ordered(std::type_identity<M>{}) && ...);
}
static_assert(in_wire_order(std::type_identity<Message>{}));

}  // namespace detail

/// Every message, in the order of the variant, which is that of the numbers.
inline constexpr auto kDialect = detail::dialect(std::type_identity<Message>{});

/// The line of a message number, or null.
constexpr const MessageInfo* find_message(std::uint8_t id) {
  const auto found =
      std::find_if(kDialect.begin(), kDialect.end(), [id](const MessageInfo& info) { return info.id == id; });
  return found == kDialect.end() ? nullptr : &*found;
}

}  // namespace ironbird::hil_bridge::rosflight
