#include "scenarios/replay/usdlog_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "scenarios/config/one_line.hpp"
#include "scenarios/record/log_bytes.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::uint8_t kUsdlogMagic = 0xBC;
constexpr std::size_t kCheckSum = 4;  // bytes

/// Takes values from bytes, little endian, until there are none: then nothing more.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  std::size_t left() const { return rest_.size(); }

  std::optional<std::uint64_t> integer(std::size_t width) {
    if (rest_.size() < width) {
      rest_ = {};
      return std::nullopt;
    }
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < width; ++k) value |= std::uint64_t{rest_[k]} << (8 * k);
    rest_ = rest_.subspan(width);
    return value;
  }

  /// Up to the zero that ends it.
  std::optional<std::string> text() {
    const auto end = std::find(rest_.begin(), rest_.end(), std::uint8_t{0});
    if (end == rest_.end()) {
      rest_ = {};
      return std::nullopt;
    }
    std::string value(rest_.begin(), end);
    rest_ = rest_.subspan(value.size() + 1);
    return value;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

/// Bytes of a variable by the letter of its type; 0: there is no such type.
std::size_t width_of(char type) {
  switch (type) {
    case 'B':
    case 'b':
      return 1;
    case 'H':
    case 'h':
      return 2;
    case 'I':
    case 'i':
    case 'f':
      return 4;
    default:
      return 0;
  }
}

double value_of(char type, std::uint64_t bits) {
  switch (type) {
    case 'b':
      return static_cast<double>(static_cast<std::int8_t>(bits));
    case 'h':
      return static_cast<double>(static_cast<std::int16_t>(bits));
    case 'i':
      return static_cast<double>(static_cast<std::int32_t>(bits));
    case 'f':
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    default:
      return static_cast<double>(bits);
  }
}

/// A type of record.
struct RecordType {
  std::string name;
  std::vector<std::string> columns;
  std::string letters;  // a variable's type each
};

/// "gyro.x(f)": its name and its letter. @return nothing for what is none
std::optional<std::pair<std::string, char>> variable_of(const std::string& text) {
  const std::size_t open = text.rfind('(');
  const bool whole = open != std::string::npos && text.size() == open + 3 && text.back() == ')';
  if (!whole || width_of(text[open + 1]) == 0) return std::nullopt;
  return std::pair(text.substr(0, open), text[open + 1]);
}

using Types = std::map<std::uint64_t, RecordType>;

std::optional<Types> read_header(ByteReader& reader) {
  if (reader.integer(1) != kUsdlogMagic) return std::nullopt;
  const auto version = reader.integer(2);
  const auto count = reader.integer(2);
  if (!version || *version < 1 || *version > 2 || !count) return std::nullopt;
  Types types;
  for (std::uint64_t k = 0; k < *count; ++k) {
    const auto id = reader.integer(2);
    const auto name = reader.text();
    const auto variables = reader.integer(2);
    if (!id || !name || !variables) return std::nullopt;
    RecordType type{*name, {"timestamp"}, ""};
    for (std::uint64_t j = 0; j < *variables; ++j) {
      const auto text = reader.text();
      const auto variable = text ? variable_of(*text) : std::nullopt;
      if (!variable) return std::nullopt;
      type.columns.push_back(variable->first);
      type.letters += variable->second;
    }
    types.emplace(*id, std::move(type));
  }
  return types;
}

/// The next record's values. @return nothing when it is cut
std::optional<std::vector<double>> read_record(ByteReader& reader, const RecordType& type) {
  const auto stamp = reader.integer(8);
  if (!stamp) return std::nullopt;
  std::vector<double> values{static_cast<double>(*stamp)};
  for (const char letter : type.letters) {
    const auto bits = reader.integer(width_of(letter));
    if (!bits) return std::nullopt;
    values.push_back(value_of(letter, *bits));
  }
  return values;
}

const RecordType& chosen(const Types& types, const std::string& name, const std::string& file) {
  std::vector<std::string> names;
  for (const auto& [id, type] : types) {
    if (type.name == name || (name.empty() && types.size() == 1)) return type;
    names.push_back(type.name);
  }
  throw TableError(file + ": there is no type of record '" + name + "'" + instead_of(name, names));
}

}  // namespace

UsdlogTable::UsdlogTable(const std::filesystem::path& file, const std::string& record)
    : UsdlogTable(read_log_bytes(file), file.string(), record) {}

UsdlogTable::UsdlogTable(const std::vector<std::uint8_t>& bytes, std::string name, const std::string& record)
    : name_(std::move(name)) {
  const std::size_t size = bytes.size() - std::min(bytes.size(), kCheckSum);
  ByteReader reader(std::span<const std::uint8_t>(bytes.data(), size));
  const auto types = read_header(reader);
  if (!types) throw TableError(name_ + ": is no log of a Crazyflie, or its header is cut");
  const RecordType& wanted = chosen(*types, record, name_);
  columns_ = wanted.columns;
  while (reader.left() > 0) {
    const std::string place = name_ + ": byte " + std::to_string(size - reader.left());
    const auto id = reader.integer(2);
    const auto type = id ? types->find(*id) : types->end();
    if (id && type == types->end()) {
      damage_ = place + ": record of a type that the header does not tell: what comes later is not read";
      return;
    }
    auto values = id ? read_record(reader, type->second) : std::nullopt;
    if (!values) {
      damage_ = place + ": the record is cut";
      return;
    }
    if (&type->second == &wanted) rows_.push_back(std::move(*values));
  }
}

std::size_t UsdlogTable::find(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
  throw TableError(
      on_one_line(name_ + ": there is no column '" + column + "'" + instead_of(column, columns_)));
}

TableNumbers UsdlogTable::numbers(const std::vector<std::string>& columns) const {
  std::vector<std::size_t> places;
  for (const std::string& column : columns) places.push_back(find(column));
  TableNumbers numbers;
  const auto leave_out = [&numbers](const std::string& why) {
    if (numbers.left_out++ == 0) numbers.first_left_out = on_one_line(why);
  };
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    std::vector<double> row;
    for (const std::size_t place : places) row.push_back(rows_[k][place]);
    const auto odd = std::find_if(row.begin(), row.end(), [](double value) { return !std::isfinite(value); });
    if (odd == row.end()) {
      numbers.rows.push_back(std::move(row));
    } else {
      leave_out(name_ + ": record " + std::to_string(k + 1) + ": column '" +
                columns_[places[static_cast<std::size_t>(odd - row.begin())]] + "' is no number");
    }
  }
  if (!damage_.empty()) leave_out(damage_);
  return numbers;
}

}  // namespace ironbird::scenarios
