#include "scenarios/replay/opened_flight.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "scenarios/config/config_error.hpp"
#include "scenarios/replay/column_map.hpp"
#include "scenarios/replay/csv_flight.hpp"
#include "scenarios/replay/ulog_file.hpp"

namespace ironbird::scenarios {

namespace {

std::string line_of(const MagCandidate& mag, bool taken) {
  if (mag.samples == 0) return "magnetometer " + std::to_string(mag.instance) + ": no field in any sample";
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(),
                "magnetometer %d%s: %.1f uT, spread %.1f %%, off the earth's field by %.1f %%", mag.instance,
                taken ? " (taken)" : "", 1e6 * mag.strength, 1e2 * mag.spread, 1e2 * mag.misfit);
  return text.data();
}

OpenedFlight open_px4(const std::filesystem::path& file, const FlightChoice& choice) {
  if (!choice.data.empty()) throw ConfigError("--data: is for the tables of a column map, MAP.toml");
  if (!choice.map_settings.empty())
    throw ConfigError("--set " + choice.map_settings.front().first + ": is for a column map, MAP.toml");
  Px4Flight px4 = read_px4_flight(UlogFile::read(file), file.string(), choice.px4);
  OpenedFlight opened;
  for (const MagCandidate& mag : px4.mags) opened.sensors.push_back(line_of(mag, px4.mag == mag.instance));
  opened.simulated = px4.simulated;
  opened.mag = px4.mag;
  opened.mag_source = px4.mag_source;
  opened.gnss_delay = px4.gnss_delay;
  opened.gnss_delay_source = px4.gnss_delay_source;
  if (px4.first_fix) opened.field = px4.field_there();
  opened.dated = px4.unix_time.has_value();
  opened.flight = std::move(px4.flight);
  return opened;
}

OpenedFlight open_tables(const std::filesystem::path& file, const FlightChoice& choice) {
  if (choice.px4.mag) throw ConfigError("--mag: is for a log of PX4; a column map names its magnetometer");
  if (choice.px4.gnss_delay)
    throw ConfigError("--gnss-delay: is for a log of PX4; a column map has gnss.delay");
  CsvFlight csv = read_csv_flight(load_column_map(file, choice.map_settings), choice.data);
  OpenedFlight opened;
  opened.flight = std::move(csv.flight);
  opened.gnss_delay = csv.gnss_delay;
  opened.gnss_delay_source = "gnss.delay of the column map";
  opened.field = csv.field;
  opened.dated = csv.dated;
  return opened;
}

bool is_table(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 3> kEndings = {".csv", ".tsv", ".txt"};
  return std::find(kEndings.begin(), kEndings.end(), file.extension().string()) != kEndings.end();
}

}  // namespace

OpenedFlight open_flight(const std::filesystem::path& file, const FlightChoice& choice) {
  if (file.extension() == ".toml") return open_tables(file, choice);
  if (is_table(file))
    throw ConfigError(
        file.string() +
        ": what the columns of a table are has to be said: replay a column map, MAP.toml, that names "
        "it; see docs/how_to/replay_a_flight.md");
  return open_px4(file, choice);
}

}  // namespace ironbird::scenarios
