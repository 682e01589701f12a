#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/replay/number_table.hpp"

namespace ironbird::scenarios {

/// The records of one type in a log that a Crazyflie wrote to its card (`.usdlog`, versions 1 and 2), with
/// their stamps, us, as the column `timestamp`. Trusts none of the bytes: what is cut, or of a type that the
/// header does not tell, ends it, and is counted as a row that was left out. The check sum at the end is not
/// looked at.
class UsdlogTable : public NumberTable {
 public:
  /// @param record  name of the type; the only one need not be named
  /// @throws UserError when the file cannot be read, TableError when it is no such log or has no such type
  UsdlogTable(const std::filesystem::path& file, const std::string& record);

  /// @param name  of the file in messages
  UsdlogTable(const std::vector<std::uint8_t>& bytes, std::string name, const std::string& record);

  std::size_t find(const std::string& column) const override;
  TableNumbers numbers(const std::vector<std::string>& columns) const override;
  const std::string& name() const override { return name_; }

 private:
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> rows_;
  std::string damage_;  // why the last row is missing; empty: none is
};

}  // namespace ironbird::scenarios
