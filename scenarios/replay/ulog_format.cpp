#include "scenarios/replay/ulog_format.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace ironbird::scenarios {

namespace {

std::optional<UlogType> primitive(std::string_view name) {
  for (const auto& [type, text] : enumerators(UlogType{})) {
    if (text == name) return type;
  }
  return std::nullopt;
}

}  // namespace

std::size_t size_of(UlogType type) {
  switch (type) {
    case UlogType::kInt8:
    case UlogType::kUint8:
    case UlogType::kBool:
    case UlogType::kChar:
      return 1;
    case UlogType::kInt16:
    case UlogType::kUint16:
      return 2;
    case UlogType::kInt32:
    case UlogType::kUint32:
    case UlogType::kFloat:
      return 4;
    case UlogType::kInt64:
    case UlogType::kUint64:
    case UlogType::kDouble:
      return 8;
  }
  return 1;
}

std::optional<UlogFormatField> parse_ulog_field(std::string_view text) {
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos || space == 0 || space + 1 == text.size()) return std::nullopt;
  UlogFormatField field;
  field.name = text.substr(space + 1);
  std::string_view type = text.substr(0, space);
  const std::size_t bracket = type.find('[');
  if (bracket != std::string_view::npos) {
    const char* const begin = type.data() + bracket + 1;
    const char* const end = type.data() + type.size() - 1;
    if (begin >= end || *end != ']') return std::nullopt;
    const auto read = std::from_chars(begin, end, field.count);
    if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
    field.is_array = true;
    type = type.substr(0, bracket);
  }
  if (type.empty()) return std::nullopt;
  field.type = type;
  return field;
}

std::optional<UlogFormat> parse_ulog_format(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) return std::nullopt;
  UlogFormat format;
  format.name = text.substr(0, colon);
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    if (end > 0) {
      std::optional<UlogFormatField> field = parse_ulog_field(rest.substr(0, end));
      if (!field) return std::nullopt;
      format.fields.push_back(std::move(*field));
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return format;
}

const UlogLayout::Field* UlogLayout::find(std::string_view field) const {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [field](const Field& candidate) { return candidate.name == field; });
  return found == fields.end() ? nullptr : &*found;
}

void UlogLayouts::add(UlogFormat format) {
  std::string name = format.name;
  formats_.try_emplace(std::move(name), std::move(format));
}

void UlogLayouts::look_again() {
  without_.clear();
}

const UlogLayout* UlogLayouts::find(std::string_view name) {
  return resolve(name, 0);
}

const UlogLayout* UlogLayouts::resolve(std::string_view name, int depth) {
  if (const auto known = layouts_.find(name); known != layouts_.end()) return &known->second;
  const auto format = formats_.find(name);
  if (format == formats_.end() || depth == kDeepest || without_.contains(name)) return nullptr;
  std::optional<UlogLayout> layout = laid_out(format->second, depth);
  if (!layout) {
    without_.emplace(name);
    return nullptr;
  }
  return &layouts_.emplace(format->first, std::move(*layout)).first->second;
}

std::optional<UlogLayout> UlogLayouts::laid_out(const UlogFormat& format, int depth) {
  UlogLayout layout;
  layout.name = format.name;
  for (const UlogFormatField& told : format.fields) {
    UlogLayout::Field field{told.name, {}, nullptr, told.count, layout.size, told.is_array};
    if (const auto type = primitive(told.type)) {
      field.type = *type;
    } else {
      field.nested = resolve(told.type, depth + 1);
      if (field.nested == nullptr) return std::nullopt;
    }
    if (told.count > (kLongest - layout.size) / field.stride()) return std::nullopt;
    layout.size += field.stride() * told.count;
    layout.fields.push_back(std::move(field));
  }
  if (layout.size == 0) return std::nullopt;
  layout.record_size = layout.size;
  for (auto last = layout.fields.rbegin(); last != layout.fields.rend() && last->is_padding(); ++last) {
    layout.record_size = last->offset;
  }
  return layout;
}

}  // namespace ironbird::scenarios
