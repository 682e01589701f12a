#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/replay/column_map.hpp"
#include "scenarios/replay/magnetic_field.hpp"
#include "scenarios/replay/recorded_flight.hpp"

namespace ironbird::scenarios {

/// A flight out of tables of numbers.
struct CsvFlight {
  RecordedFlight flight;
  double gnss_delay = 0.0;             ///< s
  std::optional<MagneticField> field;  ///< of the earth where it flew; none: nobody tells where that is
  bool dated = true;                   ///< the map tells the year of it
};

/// Takes sensors and truth out of the tables that a column map names, and makes from the truth what the map
/// says is to be made. Rows that are not whole are left out, with a remark, and those that keep the most
/// others from being in order of time. The vehicle is taken to be armed and in the air from the first row to
/// the last.
/// @param data  folder of the tables; empty: the map's own
/// @throws ConfigError for a map that does not fit the tables, UserError for a table that cannot be read or
/// an IMU without a sample
CsvFlight read_csv_flight(const LoadedColumnMap& loaded, const std::filesystem::path& data = {});

}  // namespace ironbird::scenarios
