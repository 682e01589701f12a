// Any bytes as a table of text, in several layouts, and as a log of a Crazyflie: it is refused in one line
// that names the file, or every row that it gives has a finite number for each column that was asked for.

#include <cmath>
#include <string>
#include <vector>

#include "ci/fuzzing/harness.hpp"
#include "scenarios/replay/text_table.hpp"
#include "scenarios/replay/usdlog_table.hpp"

namespace ironbird::fuzzing {

namespace {

using scenarios::NumberTable;
using scenarios::TableError;
using scenarios::TableLayout;
using scenarios::TableNumbers;
using scenarios::TextTable;
using scenarios::UsdlogTable;

// Two types of record, so that bytes become records.
constexpr std::uint8_t kUsdlogHeader[] = {0xBC, 2,   0,   2,   0,   1,   0,   'i', 'm', 'u', 0, 2,
                                          0,    'a', '(', 'f', ')', 0,   'b', '(', 'h', ')', 0, 2,
                                          0,    'p', 0,   1,   0,   'c', '(', 'B', ')', 0};

std::vector<TableLayout> layouts() {
  std::vector<TableLayout> all(5);
  all[1].delimiter = " ";
  all[2].delimiter = "ab";
  all[3].header = {"a", "b", "a"};
  all[4].lines_with = "[L]";
  all[4].skip_past = "] ";
  all[4].skip_count = 2;
  return all;
}

void expect_whole_rows(const NumberTable& table, const std::vector<std::string>& columns) {
  const TableNumbers found = table.numbers(columns);
  for (const std::vector<double>& row : found.rows) {
    require(row.size() == columns.size(), "a row has every column");
    for (const double value : row) require(std::isfinite(value), "a number is finite");
  }
  require((found.left_out == 0) == found.first_left_out.empty(), "what was left out is told");
  require(found.first_left_out.find('\n') == std::string::npos, "a complaint is one line");
}

void expect_refusal(const TableError& error) {
  const std::string what = error.what();
  require(what.starts_with("some:"), "a refusal names the file: " + what);
}

void check_text(const std::string& text, const TableLayout& layout) {
  try {
    const TextTable table(text, "some", layout);
    expect_whole_rows(table, {"a"});
    expect_whole_rows(table, {"b", "a", "b"});
  } catch (const TableError& error) {
    expect_refusal(error);
  }
}

void check_usdlog(const std::vector<std::uint8_t>& bytes) {
  try {
    const UsdlogTable table(bytes, "some", "imu");
    expect_whole_rows(table, {"timestamp", "b", "a"});
  } catch (const TableError& error) {
    expect_refusal(error);
  }
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  if (input.empty()) return;
  const std::span<const std::uint8_t> rest = input.subspan(1);
  const std::string text(rest.begin(), rest.end());
  switch (input[0] % 4) {
    case 0:
      return check_usdlog({rest.begin(), rest.end()});
    case 1: {
      std::vector<std::uint8_t> bytes(std::begin(kUsdlogHeader), std::end(kUsdlogHeader));
      bytes.insert(bytes.end(), rest.begin(), rest.end());
      return check_usdlog(bytes);
    }
    case 2:
      for (const TableLayout& layout : layouts()) check_text(text, layout);
      return;
    default:
      for (const TableLayout& layout : layouts()) check_text("[L] [L] a,b\n" + text, layout);
  }
}

}  // namespace ironbird::fuzzing
