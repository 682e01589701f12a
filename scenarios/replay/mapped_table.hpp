#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"
#include "scenarios/replay/column_map.hpp"

namespace ironbird::scenarios {

/// One table of a column map, read in SI units, its rows in order of time.
///
/// To be asked for columns first, then read. Every error is a ConfigError with the place in the map, except
/// for a file that cannot be read (UserError).
class MappedTable {
 public:
  /// @param path  of the table in the map: `imu` @param data  folder of the files; empty: the map's own
  MappedTable(const LoadedColumnMap& loaded, std::string path, const TableLayout& layout,
              const TimeColumn& time, const std::filesystem::path& data);

  /// Wants a column. @param path  in the table: `pressure` @param unit  SI. @return its number in a row
  std::size_t want(const std::string& path, const NumberColumn& column, const char* unit);
  /// Wants several. @return the number of the first
  std::size_t want(const std::string& path, const std::vector<std::string>& columns, std::size_t count,
                   const std::string& unit, const char* needed);
  /// Wants a vector. @return the number of the first of its three columns
  std::size_t want(const std::string& path, const VectorColumns& columns, const char* unit);

  /// Reads the rows. @param remarks  gets a line for what was left out
  void read(std::vector<std::string>& remarks);

  std::size_t size() const { return times_.size(); }
  /// s, on the clock of the IMU.
  double time(std::size_t row) const { return times_[row]; }
  double number(std::size_t row, std::size_t column) const { return rows_[row][column]; }
  autopilot::Vector3 vector(std::size_t row, std::size_t first) const {
    return {rows_[row][first], rows_[row][first + 1], rows_[row][first + 2]};
  }
  const std::string& name() const { return table_->name(); }

 private:
  void find(const std::string& path, const std::string& column) const;
  double size_of(const std::string& path, const std::string& unit, const char* needed) const;
  std::string inner(const std::string& path) const { return path_ + "." + path; }

  const LoadedColumnMap& loaded_;
  std::string path_;
  std::unique_ptr<const NumberTable> table_;
  double offset_;                     // s
  std::vector<std::string> columns_;  // the first is time
  std::vector<double> sizes_;         // SI units in one of theirs
  std::vector<double> times_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace ironbird::scenarios
