#include "scenarios/replay/ulog_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "scenarios/record/log_bytes.hpp"
#include "scenarios/replay/ulog_reader.hpp"

namespace ironbird::scenarios {

namespace {

/// Cut off, and the nearest there is where it does not fit; 0 for what is no number.
std::int64_t whole_number(double value) {
  constexpr double kTooGreat = 9223372036854775808.0;
  if (std::isnan(value)) return 0;
  if (value >= kTooGreat) return std::numeric_limits<std::int64_t>::max();
  if (value < -kTooGreat) return std::numeric_limits<std::int64_t>::min();
  return static_cast<std::int64_t>(value);
}

template <class Wanted, class T>
Wanted value_at(std::span<const std::uint8_t> record, std::size_t offset) {
  T value{};
  std::memcpy(&value, record.data() + offset, sizeof value);
  if constexpr (std::is_integral_v<Wanted> && std::is_floating_point_v<T>) {
    return whole_number(static_cast<double>(value));
  } else {
    return static_cast<Wanted>(value);
  }
}

/// The value there, or 0 beyond the record's end: padding is not always written.
template <class Wanted>
Wanted read(std::span<const std::uint8_t> record, std::size_t offset, UlogType type) {
  if (offset + size_of(type) > record.size()) return Wanted{};
  switch (type) {
    case UlogType::kInt8:
      return value_at<Wanted, std::int8_t>(record, offset);
    case UlogType::kUint8:
    case UlogType::kBool:
    case UlogType::kChar:
      return value_at<Wanted, std::uint8_t>(record, offset);
    case UlogType::kInt16:
      return value_at<Wanted, std::int16_t>(record, offset);
    case UlogType::kUint16:
      return value_at<Wanted, std::uint16_t>(record, offset);
    case UlogType::kInt32:
      return value_at<Wanted, std::int32_t>(record, offset);
    case UlogType::kUint32:
      return value_at<Wanted, std::uint32_t>(record, offset);
    case UlogType::kInt64:
      return value_at<Wanted, std::int64_t>(record, offset);
    case UlogType::kUint64:
      return value_at<Wanted, std::uint64_t>(record, offset);
    case UlogType::kFloat:
      return value_at<Wanted, float>(record, offset);
    case UlogType::kDouble:
      return value_at<Wanted, double>(record, offset);
  }
  return Wanted{};
}

/// One step of a path: a name, and an element in brackets where there is one.
struct Step {
  std::string_view name;
  std::optional<std::size_t> element;
};

std::optional<Step> next_step(std::string_view& path) {
  const std::size_t dot = std::min(path.find('.'), path.size());
  Step step{path.substr(0, dot), std::nullopt};
  path.remove_prefix(std::min(dot + 1, path.size()));
  const std::size_t bracket = step.name.find('[');
  if (bracket == std::string_view::npos) return step;
  if (!step.name.ends_with(']')) return std::nullopt;
  std::size_t element = 0;
  const char* const end = step.name.data() + step.name.size() - 1;
  const auto read = std::from_chars(step.name.data() + bracket + 1, end, element);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  step.name = step.name.substr(0, bracket);
  step.element = element;
  return step;
}

std::string times(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

std::optional<UlogPlace> UlogSeries::find(std::string_view path) const {
  const UlogLayout* layout = layout_;
  UlogPlace place;
  while (layout != nullptr) {
    const std::optional<Step> step = next_step(path);
    const UlogLayout::Field* const field = step ? layout->find(step->name) : nullptr;
    if (field == nullptr || step->element.value_or(0) >= field->count) return std::nullopt;
    place.offset += field->offset + step->element.value_or(0) * field->stride();
    layout = field->nested;
    if (layout != nullptr) continue;
    if (!path.empty()) return std::nullopt;
    place.type = field->type;
    place.count = step->element ? 1 : field->count;
    return place;
  }
  return std::nullopt;
}

double UlogSeries::number(std::size_t k, const UlogPlace& place, std::size_t element) const {
  return read<double>(records_[k], place.offset + element * size_of(place.type), place.type);
}

std::int64_t UlogSeries::integer(std::size_t k, const UlogPlace& place, std::size_t element) const {
  return read<std::int64_t>(records_[k], place.offset + element * size_of(place.type), place.type);
}

UlogFile UlogFile::read(const std::filesystem::path& file) {
  return from(read_log_bytes(file), file.string());
}

UlogFile UlogFile::from(std::vector<std::uint8_t> bytes, const std::string& name) {
  return UlogReader(std::move(bytes), name).read();
}

const UlogSeries* UlogFile::find(std::string_view topic, int instance) const {
  const auto found = std::find_if(series_.begin(), series_.end(), [&](const UlogSeries& series) {
    return series.topic() == topic && series.instance() == instance;
  });
  return found == series_.end() ? nullptr : &*found;
}

std::optional<double> UlogFile::parameter(std::string_view name) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end()) return std::nullopt;
  return std::visit([](auto value) { return static_cast<double>(value); }, found->second);
}

std::vector<std::string> UlogFile::complaints() const {
  std::vector<std::string> all;
  const UlogDamage& found = damage_;
  if (found.newer_version > 0)
    all.push_back("it says version " + std::to_string(found.newer_version) + "; versions 0 and 1 are known");
  if (found.cut_bytes > 0)
    all.push_back("it ends in a message without an end: " + times(found.cut_bytes, "byte") + " lost");
  if (found.skipped_bytes > 0) {
    all.push_back("it is damaged in " + times(static_cast<std::uint64_t>(found.skipped_places), "place") +
                  ": " + times(found.skipped_bytes, "byte") + " passed over");
  }
  if (found.unknown_messages > 0)
    all.push_back(times(found.unknown_messages, "message") + " of unknown types passed over");
  if (found.faulty_messages > 0)
    all.push_back(times(found.faulty_messages, "message") + " that cannot be read passed over");
  if (found.homeless_records > 0)
    all.push_back(times(found.homeless_records, "record") +
                  " of topics without announcement or format passed over");
  if (found.misfit_records > 0)
    all.push_back(times(found.misfit_records, "record") +
                  " that are not as long as their format passed over");
  if (found.dropouts > 0) {
    all.push_back("the autopilot's logger lost data " + times(found.dropouts, "time") + ", " +
                  std::to_string(found.dropout_milliseconds) + " ms together");
  }
  return all;
}

}  // namespace ironbird::scenarios
