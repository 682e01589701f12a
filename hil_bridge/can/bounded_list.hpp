#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace ironbird::hil_bridge::can {

/// An array of which only the first so many are there. Allocates nothing.
template <class T, std::size_t N>
struct BoundedList {
  static constexpr std::size_t kCapacity = N;

  std::array<T, N> items{};
  std::size_t count = 0;

  constexpr std::span<const T> view() const { return {items.data(), count}; }
  /// Appends, or does nothing when it is full.
  constexpr void push(T item) {
    if (count < N) items[count++] = item;
  }

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("items", self.items, "SI", "the first `count` are there");
    visit("count", self.count, "1", "how many");
  }
  friend constexpr bool operator==(const BoundedList& a, const BoundedList& b) {
    return std::equal(a.view().begin(), a.view().end(), b.view().begin(), b.view().end());
  }
};

/// Letters. What does not fit is cut off.
template <std::size_t N>
struct BoundedText : BoundedList<std::uint8_t, N> {
  constexpr BoundedText() = default;
  constexpr BoundedText(std::string_view text) {
    for (const char letter : text) this->push(static_cast<std::uint8_t>(letter));
  }
  std::string_view text() const { return {reinterpret_cast<const char*>(this->items.data()), this->count}; }
};

}  // namespace ironbird::hil_bridge::can
