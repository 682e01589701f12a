#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ironbird::scenarios {

/// How the lines of a text file are a table.
struct TableLayout {
  std::string file = {};
  std::string delimiter = ",";
  std::string lines_with = {};
  std::string skip_past = {};
  int skip_count = 1;
  std::vector<std::string> header = {};

  template <class Self, class Visit>
  static void describe_in(Self& self, Visit&& visit) {
    visit("file", self.file, "", "name of the table's file");
    visit("delimiter", self.delimiter, "", "between two fields; a blank: any number of blanks");
    visit("lines_with", self.lines_with, "", "only lines that hold this text are of the table; empty: all");
    visit("skip_past", self.skip_past, "",
          "a line's fields begin behind this text, such as '] ' behind '[12:30] [7] '; empty: at once");
    visit("skip_count", self.skip_count, "1", "how many of that text to pass", 1.0, 1000.0);
    visit("header", self.header, "", "names of the columns; none: the first line has them");
  }
};

/// What is wrong with a table of a file, in words that begin with its place: `file:line: ...`.
class TableError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Rows of numbers, in the order of the columns that were asked for, and what had to be left out.
struct TableNumbers {
  std::vector<std::vector<double>> rows;
  std::size_t left_out = 0;
  std::string first_left_out;  ///< the place and the reason; empty: none was

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("left_out", self.left_out, "1", "rows with a field that is missing or no finite number");
    visit("first_left_out", self.first_left_out, "", "place of the first of them, and what is wrong there");
  }
};

/// A table in a text file: comma-separated values as in RFC 4180, or with another delimiter, with something
/// in front of every line, or without a header. Names and fields are taken without the blanks around them, a
/// `#` before the header is no part of it, lines that begin with `#` and empty ones are passed over. A quoted
/// field does not go on in the next line.
class TextTable {
 public:
  /// @throws UserError when the file cannot be read, TableError when it is empty or no text
  TextTable(const std::filesystem::path& file, TableLayout layout);

  /// @param name  of the file in messages
  TextTable(std::string text, std::string name, TableLayout layout);

  // Its lines are views of its text.
  TextTable(const TextTable&) = delete;
  TextTable& operator=(const TextTable&) = delete;

  /// The place of a column. @throws TableError with the nearest name when there is none
  std::size_t find(const std::string& column) const;

  /// The rows in which all of these columns hold a finite number.
  TableNumbers numbers(const std::vector<std::string>& columns) const;

  const std::vector<std::string>& columns() const { return columns_; }
  const std::string& name() const { return name_; }

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
