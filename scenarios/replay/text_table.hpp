#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/replay/number_table.hpp"

namespace ironbird::scenarios {

/// How a file is a table: the lines of a text, or the records of one type in a log of a Crazyflie.
struct TableLayout {
  std::string file = {};
  std::string delimiter = ",";
  std::string lines_with = {};
  std::string skip_past = {};
  int skip_count = 1;
  std::vector<std::string> header = {};
  std::string record = {};

  template <class Self, class Visit>
  static void describe_in(Self& self, Visit&& visit) {
    visit("file", self.file, "", "name of the table's file");
    visit("delimiter", self.delimiter, "", "between two fields; a blank: any number of blanks");
    visit("lines_with", self.lines_with, "", "only lines that hold this text are of the table; empty: all");
    visit("skip_past", self.skip_past, "",
          "a line's fields begin behind this text, such as '] ' behind '[12:30] [7] '; empty: at once");
    visit("skip_count", self.skip_count, "1", "how many of that text to pass", 1.0, 1000.0);
    visit("header", self.header, "", "names of the columns; none: the first line has them");
    visit("record", self.record, "", "of a log of a Crazyflie, FILE.usdlog: which type of record");
  }
};

/// A table in a text file: comma-separated values as in RFC 4180, or with another delimiter, with something
/// in front of every line, or without a header. Names and fields are taken without the blanks around them, a
/// `#` before the header is no part of it, lines that begin with `#` and empty ones are passed over. A quoted
/// field does not go on in the next line.
class TextTable : public NumberTable {
 public:
  /// @throws UserError when the file cannot be read, TableError when it is empty or no text
  TextTable(const std::filesystem::path& file, TableLayout layout);

  /// @param name  of the file in messages
  TextTable(std::string text, std::string name, TableLayout layout);

  // Its lines are views of its text.
  TextTable(const TextTable&) = delete;
  TextTable& operator=(const TextTable&) = delete;

  std::size_t find(const std::string& column) const override;
  TableNumbers numbers(const std::vector<std::string>& columns) const override;
  const std::string& name() const override { return name_; }

 private:
  /// A line of the table, without what stands before its fields.
  struct Line {
    std::size_t number = 0;  ///< from 1
    std::string_view fields;
  };

  void read_lines();
  void read_header();
  std::optional<std::string_view> fields_of(std::string_view line) const;
  std::vector<std::string_view> split(std::string_view fields) const;

  std::string text_;
  std::string name_;
  TableLayout layout_;
  std::vector<Line> lines_;  // behind the header
  std::size_t header_line_ = 0;
  std::vector<std::string> columns_;
};

}  // namespace ironbird::scenarios
