#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::scenarios {

/// A line of the unit's log.
struct UnitText {
  hil_bridge::Time when{};
  std::uint8_t severity = 0;
  std::string text;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("when", self.when, "ns", "when it arrived");
    visit("severity", self.severity, "1", "0 emergency .. 7 debug; from 3 down it is an error");
    visit("text", self.text, "", "what it says");
  }
};

/// The latest of each kind of message that a unit sent, and its latest texts.
class UnitView {
 public:
  static constexpr std::size_t kTexts = 8;

  void take(const hil_bridge::Arrival& arrival);

  /// The latest message of this kind, or null.
  template <class M>
  const M* latest() const {
    const auto& entry = latest_[kind<M>()];
    return entry ? &std::get<M>(entry->message) : nullptr;
  }
  /// Messages of this kind so far.
  template <class M>
  std::uint64_t count() const {
    return counts_[kind<M>()];
  }
  /// Oldest first.
  const std::deque<UnitText>& texts() const { return texts_; }

  /// Place of a kind in the dialect.
  template <class M>
  static constexpr std::size_t kind() {
    return []<class... Each>(std::type_identity<std::variant<Each...>>) {
      std::size_t place = 0;
      bool found = false;
      ((found = found || std::is_same_v<M, Each>, place += found ? 0U : 1U), ...);
      return place;
    }(std::type_identity<hil_bridge::rosflight::Message>{});
  }

 private:
  std::array<std::optional<hil_bridge::Arrival>, std::variant_size_v<hil_bridge::rosflight::Message>> latest_;
  std::array<std::uint64_t, std::variant_size_v<hil_bridge::rosflight::Message>> counts_{};
  std::deque<UnitText> texts_;
};

}  // namespace ironbird::scenarios
