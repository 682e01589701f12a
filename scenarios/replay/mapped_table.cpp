#include "scenarios/replay/mapped_table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <system_error>
#include <utility>

#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/config/quantity.hpp"
#include "scenarios/replay/usdlog_table.hpp"

namespace ironbird::scenarios {

namespace {

namespace fs = std::filesystem;

/// Names of the files in a folder.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    names.push_back(at->path().filename().string());
  return names;
}

/// The table's file. @throws ConfigError with a name that is near when there is none
fs::path find_file(const LoadedColumnMap& loaded, const std::string& path, const TableLayout& layout,
                   const fs::path& data) {
  if (layout.file.empty()) throw loaded.error(path + ".file", "is missing: which file holds the table");
  const fs::path folder = data.empty() ? loaded.file.parent_path() : data;
  const fs::path file = folder / layout.file;
  std::error_code ignored;
  if (fs::exists(file, ignored)) return file;
  const std::string nearest = nearest_name(file.filename().string(), files_in(file.parent_path()));
  throw loaded.error(path + ".file", "there is no file " + file.string() +
                                         (nearest.empty() ? "; --data names the folder of the tables"
                                                          : "; did you mean " + nearest + "?"));
}

/// Runs `work`, and says of what it throws where in the map it is from.
template <class Work>
auto at(const LoadedColumnMap& loaded, const std::string& path, Work&& work) {
  try {
    return work();
  } catch (const TableError& error) {
    throw loaded.error(path, error.what());
  } catch (const QuantityError& error) {
    throw loaded.error(path, error.what());
  }
}

std::unique_ptr<const NumberTable> read_table(const LoadedColumnMap& loaded, const std::string& path,
                                              const TableLayout& layout, const fs::path& data) {
  const fs::path file = find_file(loaded, path, layout, data);
  if (layout.delimiter.empty()) throw loaded.error(path + ".delimiter", "must not be empty");
  return at(loaded, path + ".file", [&]() -> std::unique_ptr<const NumberTable> {
    if (file.extension() == ".usdlog") return std::make_unique<UsdlogTable>(file, layout.record);
    return std::make_unique<TextTable>(file, layout);
  });
}

/// Marks as many rows as can be whose times, the first of each row, rise: the longest rising subsequence.
std::vector<bool> in_order(const std::vector<std::vector<double>>& rows) {
  std::vector<std::size_t> ends;  // of the rising sequences of each length the one with the earliest end
  std::vector<std::size_t> before(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto place =
        std::lower_bound(ends.begin(), ends.end(), rows[row].front(),
                         [&rows](std::size_t end, double time) { return rows[end].front() < time; });
    before[row] = place == ends.begin() ? row : *std::prev(place);
    if (place == ends.end()) {
      ends.push_back(row);
    } else {
      *place = row;
    }
  }
  std::vector<bool> marked(rows.size(), false);
  for (std::size_t left = ends.size(), row = ends.empty() ? 0 : ends.back(); left > 0; --left) {
    marked[row] = true;
    row = before[row];
  }
  return marked;
}

}  // namespace

MappedTable::MappedTable(const LoadedColumnMap& loaded, std::string path, const TableLayout& layout,
                         const TimeColumn& time, const fs::path& data)
    : loaded_(loaded),
      path_(std::move(path)),
      table_(read_table(loaded, path_, layout, data)),
      offset_(to_seconds(time.offset)) {
  want("time", NumberColumn{time.column, time.unit}, "s");
}

double MappedTable::size_of(const std::string& path, const std::string& unit, const char* needed) const {
  if (unit.empty()) return 1.0;
  const bool is_quantity = unit.find_first_of("0123456789") == 0 && unit != "1";
  return at(loaded_, path, [&] { return parse_quantity(is_quantity ? unit : "1 " + unit, needed); });
}

void MappedTable::find(const std::string& path, const std::string& column) const {
  at(loaded_, path, [&] { return table_->find(column); });
}

std::size_t MappedTable::want(const std::string& path, const NumberColumn& column, const char* unit) {
  if (column.column.empty()) throw loaded_.error(inner(path) + ".column", "is missing");
  find(inner(path) + ".column", column.column);
  columns_.push_back(column.column);
  sizes_.push_back(size_of(inner(path) + ".unit", column.unit, unit));
  return columns_.size() - 1;
}

std::size_t MappedTable::want(const std::string& path, const std::vector<std::string>& columns,
                              std::size_t count, const std::string& unit, const char* needed) {
  if (columns.size() != count)
    throw loaded_.error(inner(path), "must name " + std::to_string(count) + " columns; it names " +
                                         std::to_string(columns.size()));
  const std::size_t first = columns_.size();
  const std::string unit_path = inner(path.substr(0, path.rfind('.')) + ".unit");
  for (const std::string& column : columns) {
    find(inner(path), column);
    columns_.push_back(column);
    sizes_.push_back(size_of(unit_path, unit, needed));
  }
  return first;
}

std::size_t MappedTable::want(const std::string& path, const VectorColumns& columns, const char* unit) {
  return want(path + ".columns", columns.columns, 3, columns.unit, unit);
}

void MappedTable::read(std::vector<std::string>& remarks) {
  TableNumbers found = table_->numbers(columns_);
  if (found.left_out > 0)
    remarks.push_back(path_ + ": " + std::to_string(found.left_out) +
                      " rows left out; the first: " + found.first_left_out);
  const std::vector<bool> wanted = in_order(found.rows);
  std::size_t doubted = 0;
  for (std::size_t k = 0; k < found.rows.size(); ++k) {
    std::vector<double>& row = found.rows[k];
    constexpr double kLatest = 4e9;  // s since 1970, the year 2096; of twice as many the nanoseconds fit
    const double time = row.front() * sizes_.front() + offset_;
    if (!wanted[k] || !(std::abs(time) < kLatest)) {
      ++doubted;
      continue;
    }
    for (std::size_t column = 0; column < row.size(); ++column) row[column] *= sizes_[column];
    times_.push_back(time);
    rows_.push_back(std::move(row));
  }
  if (doubted > 0)
    remarks.push_back(path_ + ": " + std::to_string(doubted) + " rows left out whose time is out of order (" +
                      table_->name() + ")");
}

}  // namespace ironbird::scenarios
