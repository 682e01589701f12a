#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "hil_bridge/can/bit_stream.hpp"
#include "hil_bridge/can/bounded_list.hpp"
#include "hil_bridge/can/dronecan_transfer.hpp"
#include "hil_bridge/can/float16.hpp"

// The bits of a message, from the message's own description: `visit(name, member, unit, meaning, width)`,
// where the width says how the member lies on the wire when that is not the width of its type.

namespace ironbird::hil_bridge::can {

/// An integer, or the elements of an array, of that many bits. Clipped when it does not fit.
struct Bits {
  unsigned count = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("count", self.count, "1", "bits on the wire");
  }
};

/// A float of 16 bits. Has no members to `describe`.
struct Half {};

/// So many zero bits first.
struct Gap {
  unsigned count = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("count", self.count, "1", "zero bits before the member");
  }
};

namespace detail {

template <class T>
inline constexpr bool kIsVariant = false;
template <class... T>
inline constexpr bool kIsVariant<std::variant<T...>> = true;
template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;
template <class T>
concept List = requires(T list) {
  T::kCapacity;
  list.items;
};

/// Bits of a number of that type.
template <class T>
constexpr unsigned natural_width() {
  return std::is_same_v<T, bool> ? 1U : static_cast<unsigned>(8 * sizeof(T));
}
template <class L>
inline constexpr unsigned kLengthBits = std::bit_width(L::kCapacity);
template <class V>
inline constexpr unsigned kTagBits = std::bit_width(std::variant_size_v<V> - 1U);

template <class T>
constexpr std::uint64_t clipped(T value, unsigned width) {
  if constexpr (std::is_same_v<T, bool>) {
    return value ? 1U : 0U;
  } else if constexpr (std::is_signed_v<T>) {
    const std::int64_t greatest = std::numeric_limits<std::int64_t>::max() >> (64U - width);
    return static_cast<std::uint64_t>(std::clamp<std::int64_t>(value, -greatest - 1, greatest));
  } else {
    return std::min<std::uint64_t>(value, ~std::uint64_t{0} >> (64U - width));
  }
}

/// Goes through a description and hands each number, with its width, to a `Sink`, whatever nests it.
/// The Sink is asked for lengths and tags, so that one walk serves writing, reading and measuring.
template <class Sink>
class Walker {
 public:
  /// @param leaves  members that are not structs themselves, of the whole message
  constexpr Walker(Sink& sink, int leaves, bool fd) : sink_(sink), leaves_(leaves), fd_(fd) {}

  template <class T, class Width = Bits>
  constexpr void operator()(const char*, T& member, const char*, const char*, Width width = {}) {
    using Bare = std::remove_const_t<T>;
    if constexpr (std::is_same_v<Width, Gap>) sink_.gap(width.count);
    if constexpr (List<Bare>) {
      list(member, width, ++done_ == leaves_ && !fd_);
    } else if constexpr (kIsVariant<Bare>) {
      ++done_;
      sink_.tag(member, kTagBits<Bare>, [&](auto& chosen) { this->content(chosen); });
    } else if constexpr (kIsArray<Bare>) {
      ++done_;
      for (auto& item : member) number(item, width);
    } else if constexpr (std::is_arithmetic_v<Bare>) {
      ++done_;
      number(member, width);
    } else {
      Bare::describe(member, *this);
    }
  }

 private:
  template <class T>
  constexpr void content(T& chosen) {
    using Bare = std::remove_const_t<T>;
    if constexpr (std::is_arithmetic_v<Bare>) number(chosen, Bits{});
    if constexpr (List<Bare>) list(chosen, Bits{}, false);
  }

  template <class T, class Width>
  constexpr void list(T& member, Width width, bool at_the_end) {
    using Item = typename decltype(member.items)::value_type;
    const unsigned bits = width_of<Item>(width);
    // The length of what comes last shows in the length of the transfer; elements of a few bits could hide in
    // the filling.
    sink_.length(member, at_the_end && bits >= 8 ? 0 : kLengthBits<std::remove_const_t<T>>, bits);
    for (std::size_t k = 0; k < member.count; ++k) number(member.items[k], width);
  }

  template <class Item, class Width>
  static constexpr unsigned width_of(Width width) {
    if constexpr (std::is_same_v<Width, Half>) return 16;
    if constexpr (std::is_same_v<Width, Bits>) return width.count != 0 ? width.count : natural_width<Item>();
    return natural_width<Item>();
  }

  template <class T, class Width>
  constexpr void number(T& value, Width width) {
    using Bare = std::remove_const_t<T>;
    if constexpr (std::is_same_v<Width, Half>) {
      sink_.half(value);
    } else if constexpr (std::is_same_v<Bare, float>) {
      sink_.single(value);
    } else {
      sink_.integer(value, width_of<Bare>(width));
    }
  }

  Sink& sink_;
  int leaves_;
  int done_ = 0;
  bool fd_;
};

/// Writes.
struct WriteSink {
  BitWriter out;

  void gap(unsigned count) { out.put(0, count); }
  void half(float value) { out.put(half_of(value), 16); }
  void single(float value) { out.put(std::bit_cast<std::uint32_t>(value), 32); }
  template <class T>
  void integer(T value, unsigned width) {
    out.put(clipped(value, width), width);
  }
  template <class L>
  void length(const L& list, unsigned width, unsigned) {
    out.put(list.count, width);
  }
  template <class V, class Content>
  void tag(const V& choice, unsigned width, Content content) {
    out.put(choice.index(), width);
    std::visit(content, choice);
  }
};

/// Reads. `sound` turns false when the bits make no sense.
struct ReadSink {
  BitReader in;
  bool sound = true;

  void gap(unsigned count) { in.take(count); }
  void half(float& value) { value = float_of(static_cast<std::uint16_t>(in.take(16))); }
  void single(float& value) { value = std::bit_cast<float>(static_cast<std::uint32_t>(in.take(32))); }
  template <class T>
  void integer(T& value, unsigned width) {
    const std::uint64_t bits = in.take(width);
    if constexpr (std::is_signed_v<T>) {
      value = static_cast<T>(static_cast<std::int64_t>(bits << (64U - width)) >> (64U - width));
    } else {
      value = static_cast<T>(bits);
    }
  }
  template <class L>
  void length(L& list, unsigned width, unsigned item_width) {
    const std::size_t count = width == 0 ? in.left() / item_width : in.take(width);
    sound = sound && count <= L::kCapacity;
    list.count = sound ? count : 0;
  }
  template <class V, class Content>
  void tag(V& choice, unsigned width, Content content) {
    const std::uint64_t index = in.take(width);
    sound = sound && index < std::variant_size_v<V>;
    if (sound) choose(choice, index, content, std::make_index_sequence<std::variant_size_v<V>>{});
  }

 private:
  template <class V, class Content, std::size_t... Index>
  static void choose(V& choice, std::uint64_t index, Content content, std::index_sequence<Index...>) {
    ((index == Index ? content(choice.template emplace<Index>()) : void()), ...);
  }
};

/// Adds up the most bits that a message can have.
struct MeasureSink {
  std::size_t bits = 0;

  constexpr void gap(unsigned count) { bits += count; }
  constexpr void half(float) { bits += 16; }
  constexpr void single(float) { bits += 32; }
  template <class T>
  constexpr void integer(T, unsigned width) {
    bits += width;
  }
  template <class L>
  constexpr void length(const L&, unsigned width, unsigned item_width) {
    bits += width + L::kCapacity * item_width;
  }
  template <class V, class Content>
  constexpr void tag(const V&, unsigned width, Content) {
    bits += width + most_of(static_cast<const V*>(nullptr));
  }

 private:
  template <class... T>
  static constexpr std::size_t most_of(const std::variant<T...>*) {
    return std::max({most<T>()...});
  }
  template <class T>
  static constexpr std::size_t most() {
    if constexpr (List<T>) return kLengthBits<T> + T::kCapacity * 8;
    if constexpr (std::is_arithmetic_v<T>) return natural_width<T>();
    return 0;
  }
};

/// Counts members that are not structs themselves.
struct LeafCounter {
  int leaves = 0;

  template <class T, class... Width>
  constexpr void operator()(const char*, T& member, const char*, const char*, Width...) {
    using Bare = std::remove_const_t<T>;
    if constexpr (List<Bare> || kIsVariant<Bare> || kIsArray<Bare> || std::is_arithmetic_v<Bare>) {
      ++leaves;
    } else {
      Bare::describe(member, *this);
    }
  }
};

template <class M>
constexpr int leaves() {
  LeafCounter counter;
  const M message{};
  M::describe(message, counter);
  return counter.leaves;
}

template <class M>
constexpr std::size_t greatest_bits() {
  MeasureSink sink;
  const M message{};
  M::describe(message, Walker<MeasureSink>(sink, leaves<M>(), true));
  return sink.bits;
}

}  // namespace detail

/// Bits of the longest payload of a message, lengths of arrays included.
template <class M>
inline constexpr std::size_t kGreatestBits = detail::greatest_bits<M>();
/// The same in bytes.
template <class M>
inline constexpr std::size_t kGreatestLength = (kGreatestBits<M> + 7) / 8;

/// What DroneCAN needs to know of a type.
struct DataType {
  std::string_view name;
  TypeKey key;
  std::uint64_t signature = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "name in the public set of definitions");
    visit("key", self.key, "", "number and kind");
    visit("signature", self.signature, "1", "stands for the definition in the checksum");
  }
};

/// The bytes of a message.
template <class M>
struct Payload {
  std::array<std::uint8_t, kGreatestLength<M> + 1> bytes{};
  std::size_t size = 0;

  std::span<const std::uint8_t> view() const { return {bytes.data(), size}; }

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("bytes", self.bytes, "1", "the first `size` count");
    visit("size", self.size, "byte", "length");
  }
};

/// @param fd  for CAN FD, where the length of an array at the end is said
template <class M>
Payload<M> encode(const M& message, bool fd = false) {
  Payload<M> payload;
  detail::WriteSink sink{BitWriter(payload.bytes)};
  M::describe(message, detail::Walker<detail::WriteSink>(sink, detail::leaves<M>(), fd));
  payload.size = sink.out.size();
  return payload;
}

/// The message that a payload holds, or nothing when it is too short, too long or senseless. A payload of CAN
/// FD may end in the zeros by which its frame was filled.
template <class M>
std::optional<M> decode(std::span<const std::uint8_t> payload, bool fd = false) {
  std::optional<M> message(std::in_place);
  detail::ReadSink sink{BitReader(payload)};
  M::describe(*message, detail::Walker<detail::ReadSink>(sink, detail::leaves<M>(), fd));
  if (!sink.sound || sink.in.overrun()) return std::nullopt;
  constexpr std::size_t kLeastPadding = 8;
  constexpr std::size_t kMostPadding = 16 * 8;
  if (sink.in.left() >= (fd ? kMostPadding : kLeastPadding)) return std::nullopt;
  while (sink.in.left() > 0) {
    if (sink.in.take(static_cast<unsigned>(std::min<std::size_t>(sink.in.left(), 8))) != 0 && fd)
      return std::nullopt;
  }
  return message;
}

/// The subscription to a message type.
template <class M>
constexpr Subscription subscription() {
  return {M::kType.key, crc_seed(M::kType.signature), static_cast<std::uint16_t>(kGreatestLength<M>)};
}

}  // namespace ironbird::hil_bridge::can
