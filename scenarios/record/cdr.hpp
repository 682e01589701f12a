#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "scenarios/record/byte_buffer.hpp"
#include "scenarios/record/described.hpp"

namespace ironbird::scenarios {

/// Appends one described struct to a buffer in the plain little-endian encoding of ROS 2 messages (XCDR1).
///
/// Four bytes of header come first; numbers are aligned to their size, counted from behind the header. Which
/// message type the bytes are is said by ros2_schema.hpp. Allocates only while the buffer has not yet seen
/// its largest content.
class CdrEncoder {
 public:
  explicit CdrEncoder(ByteBuffer& out) : out_(out) {
    out_.reserve_more(kSlack);
    cursor_ = out_.data() + out_.size();
    end_ = out_.data() + out_.capacity();
    constexpr std::uint8_t kHeader[4] = {0x00, 0x01, 0x00, 0x00};
    std::memcpy(cursor_, kHeader, sizeof kHeader);
    cursor_ += sizeof kHeader;
    origin_ = cursor_;
  }

  template <class T>
  void write(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      write_fixed<1>(&value);
    } else if constexpr (NamedEnum<T>) {
      write(static_cast<std::uint8_t>(value));
    } else if constexpr (kIsTime<T>) {
      write_time(value);
    } else if constexpr (kIsQuaternion<T>) {
      write_fixed<4>(value.coeffs().data());  // stored as x, y, z, w
    } else if constexpr (IsMatrix<T>::value) {
      write_matrix(value);
    } else if constexpr (std::is_same_v<T, std::string>) {
      write_text(value);
    } else if constexpr (IsCharArray<T>::value) {
      write_text(std::string_view(value.data(), ::strnlen(value.data(), value.size())));
    } else if constexpr (IsArray<T>::value) {
      write_elements(value);
    } else if constexpr (IsVector<T>::value) {
      write(static_cast<std::uint32_t>(value.size()));
      write_elements(value);
    } else if constexpr (IsOptional<T>::value) {
      write(std::uint32_t{value.has_value()});
      if (value) write(*value);
    } else if constexpr (IsVariant<T>::value) {
      write_variant(value, std::make_index_sequence<std::variant_size_v<T>>{});
    } else if constexpr (kIsEmptyStruct<T>) {
      write(std::uint8_t{0});
    } else if constexpr (Described<T>) {
      T::describe(value, Member{*this});
    } else {
      static_assert(kNoCase<T>, "no message type for this member");
    }
  }

  /// Hands the bytes to the buffer. Nothing may be written afterwards.
  void finish() { out_.set_size(static_cast<std::size_t>(cursor_ - out_.data())); }

 private:
  /// What an aligned number may need beyond its own size, and the header.
  static constexpr std::size_t kSlack = 16;

  struct Member {
    CdrEncoder& encoder;
    template <class T>
    void operator()(const char*, const T& value, const char*, const char*, double = 0.0, double = 0.0) const {
      encoder.write(value);
    }
  };

  /// As write_numbers, for a number of numbers that the compiler knows: a few moves instead of two calls.
  template <std::size_t count, class Number>
  [[gnu::always_inline]] void write_fixed(const Number* numbers) {
    make_ready<Number>(count * sizeof(Number));
    std::memcpy(cursor_, numbers, count * sizeof(Number));
    cursor_ += count * sizeof(Number);
  }

  /// Makes room for `size` bytes and aligns the cursor, with zeros in front of it.
  template <class Number>
  [[gnu::always_inline]] void make_ready(std::size_t size) {
    if (static_cast<std::size_t>(end_ - cursor_) < size + kSlack) grow(size + kSlack);
    if constexpr (sizeof(Number) > 1) {
      std::memset(cursor_, 0, sizeof(Number));
      const auto offset = static_cast<std::size_t>(cursor_ - origin_);
      cursor_ = origin_ + ((offset + sizeof(Number) - 1) & ~(sizeof(Number) - 1));
    }
  }

  template <class Number>
  void write_numbers(const Number* numbers, std::size_t count) {
    const std::size_t size = count * sizeof(Number);
    make_ready<Number>(size);
    std::memcpy(cursor_, numbers, size);
    cursor_ += size;
  }

  void write_time(std::chrono::nanoseconds time) {
    const auto whole = std::chrono::floor<std::chrono::seconds>(time);
    write(static_cast<std::int32_t>(whole.count()));
    write(static_cast<std::uint32_t>((time - whole).count()));
  }

  template <class Matrix>
  void write_matrix(const Matrix& matrix) {
    if constexpr (Matrix::ColsAtCompileTime == 1 || Matrix::IsRowMajor) {
      if constexpr (Matrix::SizeAtCompileTime != Eigen::Dynamic) {
        write_fixed<static_cast<std::size_t>(Matrix::SizeAtCompileTime)>(matrix.data());
      } else {
        write_numbers(matrix.data(), static_cast<std::size_t>(matrix.size()));
      }
    } else {
      for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        for (Eigen::Index column = 0; column < matrix.cols(); ++column) write(matrix(row, column));
      }
    }
  }

  void write_text(std::string_view text) {
    write(static_cast<std::uint32_t>(text.size() + 1));
    write_numbers(text.data(), text.size());
    write(std::uint8_t{0});
  }

  template <class Elements>
  void write_elements(const Elements& elements) {
    using Element = typename Elements::value_type;
    if constexpr (std::is_arithmetic_v<Element> && !std::is_same_v<Element, bool>) {
      if (!elements.empty()) write_numbers(elements.data(), elements.size());
    } else {
      for (const Element& element : elements) write(element);
    }
  }

  template <class Variant, std::size_t... Index>
  void write_variant(const Variant& value, std::index_sequence<Index...>) {
    write(static_cast<std::uint8_t>(value.index()));
    (write_alternative(std::get_if<Index>(&value)), ...);
  }

  template <class Alternative>
  void write_alternative(const Alternative* chosen) {
    if constexpr (!kIsEmptyStruct<Alternative>) {
      write(std::uint32_t{chosen != nullptr});
      if (chosen != nullptr) write(*chosen);
    }
  }

  [[gnu::noinline]] void grow(std::size_t more) {
    const auto begin = static_cast<std::size_t>(origin_ - out_.data());
    out_.set_size(static_cast<std::size_t>(cursor_ - out_.data()));
    out_.reserve_more(more);
    cursor_ = out_.data() + out_.size();
    origin_ = out_.data() + begin;
    end_ = out_.data() + out_.capacity();
  }

  ByteBuffer& out_;
  std::uint8_t* cursor_ = nullptr;
  std::uint8_t* end_ = nullptr;
  std::uint8_t* origin_ = nullptr;
};

/// Appends `value` to `out` as one CDR message.
template <class T>
void encode_cdr(const T& value, ByteBuffer& out) {
  CdrEncoder encoder(out);
  encoder.write(value);
  encoder.finish();
}

}  // namespace ironbird::scenarios
