#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "scenarios/config/user_error.hpp"
#include "scenarios/record/byte_cursor.hpp"
#include "scenarios/record/described.hpp"

namespace ironbird::scenarios {

/// Reads described structs out of the bytes that CdrEncoder makes of them. Trusts none: whatever they are, it
/// ends with a value or an exception, and takes no more memory than a constant times their number.
class CdrDecoder {
 public:
  /// @throws std::out_of_range when there is no header
  explicit CdrDecoder(std::span<const std::uint8_t> message) : rest_(message) {
    constexpr std::uint8_t kHeader[4] = {0x00, 0x01, 0x00, 0x00};
    const auto header = rest_.take(sizeof kHeader);
    if (!std::equal(header.begin(), header.end(), kHeader)) throw UserError("has another encoding than ours");
    size_ = rest_.rest().size();
  }

  /// @throws std::out_of_range when the bytes end too early, UserError when they are none of a T
  template <class T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = number<std::uint8_t>() != 0;
    } else if constexpr (std::is_arithmetic_v<T>) {
      value = number<T>();
    } else if constexpr (NamedEnum<T>) {
      read_enumerator(value);
    } else if constexpr (kIsTime<T>) {
      const std::chrono::seconds whole(number<std::int32_t>());
      value = whole + std::chrono::nanoseconds(number<std::uint32_t>());
    } else if constexpr (kIsQuaternion<T>) {
      for (double& coefficient : value.coeffs()) coefficient = number<double>();
    } else if constexpr (IsMatrix<T>::value) {
      read_matrix(value);
    } else if constexpr (std::is_same_v<T, std::string>) {
      value = text();
    } else if constexpr (IsCharArray<T>::value) {
      read_characters(value);
    } else if constexpr (IsArray<T>::value) {
      for (auto& element : value) read(element);
    } else if constexpr (IsVector<T>::value) {
      read_sequence(value);
    } else if constexpr (IsOptional<T>::value) {
      value.reset();
      if (is_present()) read(value.emplace());
    } else if constexpr (IsVariant<T>::value) {
      read_variant(value, std::make_index_sequence<std::variant_size_v<T>>{});
    } else if constexpr (kIsEmptyStruct<T>) {
      number<std::uint8_t>();
    } else if constexpr (Described<T>) {
      T::describe(value, Member{*this});
    } else {
      static_assert(kNoCase<T>, "no message type for this member");
    }
  }

  /// Bytes that nobody has read yet.
  std::size_t left() const { return rest_.rest().size(); }

 private:
  struct Member {
    CdrDecoder& decoder;
    template <class T>
    void operator()(const char*, T& value, const char*, const char*, double = 0.0, double = 0.0) const {
      decoder.read(value);
    }
  };

  template <class Number>
  Number number() {
    const std::size_t offset = size_ - left();
    rest_.take((sizeof(Number) - offset % sizeof(Number)) % sizeof(Number));
    return rest_.get<Number>();
  }

  template <class Enum>
  void read_enumerator(Enum& value) {
    const auto number_of_it = number<std::uint8_t>();
    for (const auto& [enumerator, name] : enumerators(Enum{})) {
      if (static_cast<std::uint8_t>(enumerator) != number_of_it) continue;
      value = enumerator;
      return;
    }
    throw UserError("holds " + std::to_string(number_of_it) + " where no name is known for it");
  }

  template <class Matrix>
  void read_matrix(Matrix& matrix) {
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index column = 0; column < matrix.cols(); ++column) matrix(row, column) = number<double>();
    }
  }

  /// Ends with a NUL, which is counted.
  std::string text() {
    const auto bytes = rest_.take(number<std::uint32_t>());
    if (bytes.empty() || bytes.back() != 0) throw UserError("holds a text without an end");
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
  }

  template <std::size_t N>
  void read_characters(std::array<char, N>& value) {
    const std::string characters = text();
    if (characters.size() > N) throw UserError("holds a text of more letters than there is room for");
    value.fill('\0');
    std::copy(characters.begin(), characters.end(), value.begin());
  }

  template <class Elements>
  void read_sequence(Elements& elements) {
    const auto count = number<std::uint32_t>();
    elements.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      typename Elements::value_type element{};
      read(element);
      elements.push_back(std::move(element));
    }
  }

  bool is_present() {
    const auto count = number<std::uint32_t>();
    if (count > 1) throw UserError("holds " + std::to_string(count) + " of what there is one of at most");
    return count == 1;
  }

  template <class Variant, std::size_t... Index>
  void read_variant(Variant& value, std::index_sequence<Index...>) {
    const std::size_t index = number<std::uint8_t>();
    if (index >= sizeof...(Index)) throw UserError("holds a kind that is not known");
    (read_alternative<Index>(value, Index == index), ...);
  }

  template <std::size_t Index, class Variant>
  void read_alternative(Variant& value, bool chosen) {
    using Alternative = std::variant_alternative_t<Index, Variant>;
    if constexpr (!kIsEmptyStruct<Alternative>) {
      if (is_present() != chosen) throw UserError("holds another kind than it says");
      if (chosen) read(value.template emplace<Index>());
    } else if (chosen) {
      value.template emplace<Index>();
    }
  }

  ByteCursor rest_;
  std::size_t size_ = 0;  // of the content, from which alignment is counted
};

/// The struct that a message holds. @throws UserError when it is none of a T, or more than one
template <class T>
T decode_cdr(std::span<const std::uint8_t> message) {
  T value{};
  try {
    CdrDecoder decoder(message);
    decoder.read(value);
    if (decoder.left() > 0) throw UserError("is longer than its type");
  } catch (const std::out_of_range& error) {
    throw UserError(error.what());
  }
  return value;
}

}  // namespace ironbird::scenarios
