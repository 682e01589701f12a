#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace ironbird::scenarios {

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

/// A table of numbers with named columns, whatever its file is.
class NumberTable {
 public:
  virtual ~NumberTable() = default;

  /// The place of a column. @throws TableError with the nearest name when there is none
  virtual std::size_t find(const std::string& column) const = 0;

  /// The rows in which all of these columns hold a finite number. @throws TableError as find()
  virtual TableNumbers numbers(const std::vector<std::string>& columns) const = 0;

  /// Of the file, for messages.
  virtual const std::string& name() const = 0;
};

/// Which column was meant, or which there are: "; did you mean 'a'?", "; there are: a, b".
std::string instead_of(const std::string& column, const std::vector<std::string>& columns);

}  // namespace ironbird::scenarios
