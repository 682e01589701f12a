#include "scenarios/replay/replay_sources.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/config/degrees.hpp"
#include "scenarios/config/file_search.hpp"
#include "scenarios/replay/magnetic_field.hpp"
#include "scenarios/replay/opened_flight.hpp"
#include "scenarios/replay/provenance.hpp"
#include "scenarios/replay/run_log.hpp"
#include "scenarios/replay/run_replay.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kUsualScenario = "scenarios/replay/recorded_flight.toml";

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// The declination to fly with, rad, and where it is from.
struct Declination {
  double angle = 0.0;
  std::string source;
};

Declination declination_of(const FlightArguments& arguments, const OpenedFlight& opened,
                           std::vector<std::string>& remarks) {
  if (!arguments.declination.empty()) {
    const auto named = number_of(arguments.declination);
    if (!named || std::abs(*named) > 180.0)
      throw ConfigError("--declination " + arguments.declination +
                        ": must be an angle in degrees, east positive");
    return {*named / kDegreesPerRadian, "as named"};
  }
  if (!opened.field) return {0.0, "0, for there is no place to ask for"};
  if (!opened.dated)
    remarks.emplace_back("nothing tells the date: the declination is that of the newest model");
  const std::string edition = std::to_string(opened.field->edition);
  if (!opened.field->current)
    remarks.push_back(
        "no World Magnetic Model that is known is meant for its date: the declination is that of " + edition);
  return {opened.field->declination,
          "World Magnetic Model " + edition + ", meant for the five years from then"};
}

/// A flight that others recorded.
class OpenedSource final : public ReplaySource {
 public:
  OpenedSource(const FlightArguments& arguments,
               const std::vector<std::pair<std::string, std::string>>& map_settings) {
    FlightChoice choice;
    if (arguments.mag >= 0) choice.px4.mag = arguments.mag;
    if (arguments.gnss_delay >= 0.0) choice.px4.gnss_delay = arguments.gnss_delay;
    choice.data = arguments.data;
    choice.map_settings = map_settings;
    opened_ = open_flight(arguments.flight, choice);
    declination_ = declination_of(arguments, opened_, opened_.flight.remarks);
  }

  const RecordedFlight& flight() const override { return opened_.flight; }

  LoadedScenario load(const PilotChoice& choice, const autopilot::Modules& modules) const override {
    auto settings = choice.settings;
    settings.insert(settings.begin(), {"environment.magnetic_field.declination",
                                       std::to_string(declination_.angle * kDegreesPerRadian) + " deg"});
    std::filesystem::path file = choice.scenario;
    if (file.empty()) file = find_named(kUsualScenario, search_folders(kUsualScenario));
    return load_scenario(file, {settings, std::nullopt}, modules);
  }

  ReplayResult replay(const LoadedScenario& loaded, const autopilot::Modules& modules,
                      ReplayOptions options) const override {
    return Replay(opened_.flight, loaded, modules, std::move(options)).run();
  }

  ReplayedFlight provenance() const override {
    ReplayedFlight told = provenance_of(opened_.flight);
    told.simulated = opened_.simulated;
    told.magnetometer = opened_.mag;
    told.magnetometer_source = opened_.mag_source;
    told.declination = declination_.angle;
    told.declination_source = declination_.source;
    told.gnss_delay = opened_.gnss_delay;
    told.gnss_delay_source = opened_.gnss_delay_source;
    return told;
  }

  std::vector<std::string> about() const override {
    std::vector<std::string> lines{
        formatted("%s, %.1f s of IMU samples", opened_.flight.what.c_str(), to_seconds(opened_.flight.end))};
    for (const std::string& line : opened_.sensors) lines.push_back("  " + line);
    lines.push_back(formatted("  declination %+.2f deg (%s); fixes %.0f ms old on arrival",
                              declination_.angle * kDegreesPerRadian, declination_.source.c_str(),
                              1e3 * opened_.gnss_delay));
    return lines;
  }

 private:
  OpenedFlight opened_;
  Declination declination_;
};

/// The log of a run of ours.
class RunSource final : public ReplaySource {
 public:
  explicit RunSource(const FlightArguments& arguments)
      : file_(arguments.flight), log_(RunLog::read(arguments.flight)) {
    const std::pair<const char*, bool> given[] = {{"--mag", arguments.mag >= 0},
                                                  {"--declination", !arguments.declination.empty()},
                                                  {"--gnss-delay", arguments.gnss_delay >= 0.0},
                                                  {"--start", arguments.start > 0.0},
                                                  {"--data", !arguments.data.empty()}};
    for (const auto& [option, is_given] : given) {
      if (is_given)
        throw ConfigError(std::string(option) + ": is for flights of others; " + arguments.flight +
                          " holds what its own autopilot was told, from the beginning");
    }
  }

  const RecordedFlight& flight() const override { return log_.flight(); }

  LoadedScenario load(const PilotChoice& choice, const autopilot::Modules& modules) const override {
    const Overrides changes{choice.settings, std::nullopt};
    if (!choice.scenario.empty()) return load_scenario(choice.scenario, changes, modules);
    return load_flown(file_, log_.configuration(), changes, modules);
  }

  ReplayResult replay(const LoadedScenario& loaded, const autopilot::Modules& modules,
                      ReplayOptions options) const override {
    return RunReplay(log_, loaded, modules, std::move(options)).run();
  }

  ReplayedFlight provenance() const override {
    ReplayedFlight told = provenance_of(log_.flight());
    told.simulated = log_.simulated();
    // Its autopilot was told of field and fixes; nobody had to find out.
    told.declination = told.gnss_delay = std::numeric_limits<double>::quiet_NaN();
    return told;
  }

  std::vector<std::string> about() const override {
    return {formatted("%s, %.1f s", log_.flight().what.c_str(), to_seconds(log_.flight().end))};
  }

 private:
  std::filesystem::path file_;
  RunLog log_;
};

}  // namespace

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::unique_ptr<ReplaySource> ReplaySource::open(
    const FlightArguments& arguments, const std::vector<std::pair<std::string, std::string>>& map_settings) {
  if (!is_mcap(arguments.flight)) return std::make_unique<OpenedSource>(arguments, map_settings);
  if (!map_settings.empty())
    throw ConfigError("--set " + map_settings.front().first + ": is for a column map, MAP.toml");
  return std::make_unique<RunSource>(arguments);
}

}  // namespace ironbird::scenarios
