#include "scenarios/replay/ulog_values.hpp"

#include <string>

namespace ironbird::scenarios {

namespace {

using Bytes = std::span<const std::uint8_t>;

template <class T>
std::string number_text(Bytes value) {
  return std::to_string(ulog_value<T>(value, 0));
}

}  // namespace

std::string_view ulog_text(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::optional<UlogKeyed> ulog_keyed(Bytes content) {
  if (content.empty()) return std::nullopt;
  const std::size_t length = content[0];
  if (1 + length > content.size()) return std::nullopt;
  const auto key = parse_ulog_field(ulog_text(content.subspan(1, length)));
  if (!key) return std::nullopt;
  return UlogKeyed{*key, content.subspan(1 + length)};
}

std::optional<std::string> ulog_value_text(const UlogKeyed& found) {
  if (found.key.type == "char") {
    if (found.value.size() != found.key.count) return std::nullopt;
    return std::string(ulog_text(found.value));
  }
  for (const auto& [type, name] : enumerators(UlogType{})) {
    if (name != found.key.type) continue;
    if (found.value.size() != size_of(type) * found.key.count || found.value.empty()) return std::nullopt;
    switch (type) {
      case UlogType::kInt8:
        return number_text<std::int8_t>(found.value);
      case UlogType::kUint8:
      case UlogType::kBool:
      case UlogType::kChar:
        return number_text<std::uint8_t>(found.value);
      case UlogType::kInt16:
        return number_text<std::int16_t>(found.value);
      case UlogType::kUint16:
        return number_text<std::uint16_t>(found.value);
      case UlogType::kInt32:
        return number_text<std::int32_t>(found.value);
      case UlogType::kUint32:
        return number_text<std::uint32_t>(found.value);
      case UlogType::kInt64:
        return number_text<std::int64_t>(found.value);
      case UlogType::kUint64:
        return number_text<std::uint64_t>(found.value);
      case UlogType::kFloat:
        return number_text<float>(found.value);
      case UlogType::kDouble:
        return number_text<double>(found.value);
    }
  }
  return std::nullopt;
}

std::optional<UlogNumber> ulog_parameter(const UlogKeyed& found) {
  if (found.value.size() != sizeof(std::int32_t)) return std::nullopt;
  if (found.key.type == "int32_t") return UlogNumber(ulog_value<std::int32_t>(found.value, 0));
  if (found.key.type == "float") return UlogNumber(ulog_value<float>(found.value, 0));
  return std::nullopt;
}

}  // namespace ironbird::scenarios
