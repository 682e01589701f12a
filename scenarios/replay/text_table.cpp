#include "scenarios/replay/text_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>

#include "scenarios/config/one_line.hpp"
#include "scenarios/record/log_bytes.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t\r";

std::string text_of(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_log_bytes(file);
  return {bytes.begin(), bytes.end()};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string_view unquoted(std::string_view field) {
  const std::string_view text = trimmed(field);
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

std::optional<double> finite_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = read.ec == std::errc() && read.ptr == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string place(const std::string& name, std::size_t line) {
  return name + ":" + std::to_string(line) + ": ";
}

}  // namespace

TextTable::TextTable(const std::filesystem::path& file, TableLayout layout)
    : TextTable(text_of(file), file.string(), std::move(layout)) {}

TextTable::TextTable(std::string text, std::string name, TableLayout layout)
    : text_(std::move(text)), name_(std::move(name)), layout_(std::move(layout)) {
  if (text_.find('\0') != std::string::npos)
    throw TableError(name_ + ": is no text; a column map reads tables of text");
  read_lines();
  read_header();
}

void TextTable::read_lines() {
  std::string_view rest = text_;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const auto fields = fields_of(line);
    if (!fields || trimmed(*fields).empty()) continue;
    const bool is_header = lines_.empty() && layout_.header.empty();
    if (fields->starts_with('#') && !is_header) continue;
    lines_.push_back({number, *fields});
  }
}

/// @return nothing for a line that is not of the table
std::optional<std::string_view> TextTable::fields_of(std::string_view line) const {
  if (line.find(layout_.lines_with) == std::string_view::npos) return std::nullopt;
  for (int k = 0; !layout_.skip_past.empty() && k < layout_.skip_count; ++k) {
    const std::size_t found = line.find(layout_.skip_past);
    if (found == std::string_view::npos) return std::nullopt;
    line.remove_prefix(found + layout_.skip_past.size());
  }
  return line;
}

void TextTable::read_header() {
  if (lines_.empty()) {
    const bool chosen = !layout_.lines_with.empty() || !layout_.skip_past.empty();
    throw TableError(name_ + ": " +
                     (text_.empty() ? "is empty"
                      : chosen ? "has no line of this table; see its lines_with, skip_past and skip_count"
                               : "has no line"));
  }
  if (!layout_.header.empty()) {
    columns_ = layout_.header;
    return;
  }
  header_line_ = lines_.front().number;
  std::string_view header = lines_.front().fields;
  if (header.starts_with('#')) header.remove_prefix(1);
  for (const std::string_view field : split(header)) columns_.emplace_back(field);
  lines_.erase(lines_.begin());
}

std::vector<std::string_view> TextTable::split(std::string_view fields) const {
  std::vector<std::string_view> result;
  const bool by_blanks = layout_.delimiter == " ";
  std::string_view rest = by_blanks ? trimmed(fields) : fields;
  for (;;) {
    const std::size_t begin = rest.find_first_not_of(kBlanks);
    const bool quoted = begin != std::string_view::npos && rest[begin] == '"';
    const std::size_t from = quoted ? rest.find('"', begin + 1) : 0;
    const std::size_t end = from == std::string_view::npos ? from
                            : by_blanks                    ? rest.find_first_of(kBlanks, from)
                                                           : rest.find(layout_.delimiter, from);
    result.push_back(unquoted(rest.substr(0, end)));
    if (end == std::string_view::npos) return result;
    rest.remove_prefix(end + layout_.delimiter.size());
    if (by_blanks) rest = trimmed(rest);
  }
}

std::size_t TextTable::find(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), trimmed(column));
  if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
  const std::string where = header_line_ == 0 ? name_ + ": " : place(name_, header_line_);
  throw TableError(where + "there is no column '" + column + "'" + instead_of(column, columns_));
}

TableNumbers TextTable::numbers(const std::vector<std::string>& columns) const {
  std::vector<std::size_t> places;
  for (const std::string& column : columns) places.push_back(find(column));
  TableNumbers numbers;
  const auto leave_out = [&](const Line& line, const std::string& why) {
    if (numbers.left_out++ == 0) numbers.first_left_out = on_one_line(place(name_, line.number) + why);
  };
  for (const Line& line : lines_) {
    const std::vector<std::string_view> fields = split(line.fields);
    std::vector<double> row;
    for (const std::size_t column : places) {
      if (column >= fields.size()) {
        leave_out(line, "has " + std::to_string(fields.size()) + " fields; column '" + columns_[column] +
                            "' is number " + std::to_string(column + 1));
        break;
      }
      const auto value = finite_number(fields[column]);
      if (!value) {
        leave_out(line,
                  "column '" + columns_[column] + "' is no number: '" + std::string(fields[column]) + "'");
        break;
      }
      row.push_back(*value);
    }
    if (row.size() == places.size()) numbers.rows.push_back(std::move(row));
  }
  return numbers;
}

}  // namespace ironbird::scenarios
