#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scenarios/replay/ulog_file.hpp"

// Makes ULog files byte by byte.

namespace ironbird::scenarios::test {

/// A log that is being written. Every call appends one message.
class UlogByHand {
 public:
  explicit UlogByHand(std::uint8_t version = 1) {
    bytes_ = {'U', 'L', 'o', 'g', 0x01, 0x12, 0x35, version};
    put(bytes_, std::uint64_t{112});
  }

  UlogByHand& message(char type, const std::vector<std::uint8_t>& content) {
    put(bytes_, static_cast<std::uint16_t>(content.size()));
    bytes_.push_back(static_cast<std::uint8_t>(type));
    bytes_.insert(bytes_.end(), content.begin(), content.end());
    return *this;
  }
  UlogByHand& format(std::string_view text) { return message('F', bytes_of(text)); }
  UlogByHand& subscribe(std::uint8_t instance, std::uint16_t id, std::string_view topic) {
    std::vector<std::uint8_t> content{instance};
    put(content, id);
    append(content, topic);
    return message('A', content);
  }
  template <class... Values>
  UlogByHand& record(std::uint16_t id, Values... values) {
    std::vector<std::uint8_t> content;
    put(content, id);
    (put(content, values), ...);
    return message('D', content);
  }
  template <class Value>
  requires std::is_arithmetic_v<Value> UlogByHand& keyed(char type, std::string_view key, Value value) {
    std::vector<std::uint8_t> content{static_cast<std::uint8_t>(key.size())};
    append(content, key);
    put(content, value);
    return message(type, content);
  }
  UlogByHand& keyed(char type, std::string_view key, std::string_view value) {
    std::vector<std::uint8_t> content{static_cast<std::uint8_t>(key.size())};
    append(content, key);
    append(content, value);
    return message(type, content);
  }
  UlogByHand& flags(std::uint8_t incompatible, std::uint64_t appended = 0) {
    std::vector<std::uint8_t> content(16);
    content[8] = incompatible;
    put(content, appended);
    put(content, std::uint64_t{0});
    put(content, std::uint64_t{0});
    return message('B', content);
  }
  UlogByHand& sync() { return message('S', {0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12}); }
  UlogByHand& raw(const std::vector<std::uint8_t>& bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }

  std::vector<std::uint8_t>& bytes() { return bytes_; }
  std::size_t size() const { return bytes_.size(); }
  UlogFile read() const { return UlogFile::from(bytes_, "by_hand.ulg"); }

  static std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

 private:
  template <class Value>
  static void put(std::vector<std::uint8_t>& to, Value value) {
    std::uint8_t bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    to.insert(to.end(), bytes, bytes + sizeof value);
  }
  static void append(std::vector<std::uint8_t>& to, std::string_view text) {
    to.insert(to.end(), text.begin(), text.end());
  }

  std::vector<std::uint8_t> bytes_;
};

}  // namespace ironbird::scenarios::test
