#include "scenarios/replay/replay_sources.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/config/file_search.hpp"
#include "scenarios/replay/magnetic_field.hpp"
#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/replay/run_log.hpp"
#include "scenarios/replay/run_replay.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kUsualScenario = "scenarios/replay/recorded_flight.toml";

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The declination to fly with, rad, and where it is from.
struct Declination {
  double angle = 0.0;
  std::string source;
};

Declination declination_of(const FlightArguments& arguments, const Px4Flight& px4,
                           std::vector<std::string>& remarks) {
  if (!arguments.declination.empty()) {
    const auto named = number_of(arguments.declination);
    if (!named || std::abs(*named) > 180.0)
      throw ConfigError("--declination " + arguments.declination +
                        ": must be an angle in degrees, east positive");
    return {*named / kDegrees, "as named"};
  }
  if (!px4.first_fix) return {0.0, "0, for there is no place to ask for"};
  if (!px4.unix_time)
    remarks.emplace_back("its fixes do not tell the date: the declination is that of the newest model");
  const MagneticField field = px4.field_there();
  const std::string edition = std::to_string(field.edition);
  if (!field.current)
    remarks.push_back(
        "no World Magnetic Model that is known is meant for its date: the declination is that of " + edition);
  return {field.declination, "World Magnetic Model " + edition + ", meant for the five years from then"};
}

/// The log of a PX4 autopilot.
class Px4Source final : public ReplaySource {
 public:
  explicit Px4Source(const FlightArguments& arguments) {
    Px4Choice choice;
    if (arguments.mag >= 0) choice.mag = arguments.mag;
    if (arguments.gnss_delay >= 0.0) choice.gnss_delay = arguments.gnss_delay;
    px4_ = read_px4_flight(UlogFile::read(arguments.flight), arguments.flight, choice);
    declination_ = declination_of(arguments, px4_, px4_.flight.remarks);
  }

  const RecordedFlight& flight() const override { return px4_.flight; }

  LoadedScenario load(const PilotChoice& choice, const autopilot::Modules& modules) const override {
    auto settings = choice.settings;
    settings.insert(settings.begin(), {"environment.magnetic_field.declination",
                                       std::to_string(declination_.angle * kDegrees) + " deg"});
    std::filesystem::path file = choice.scenario;
    if (file.empty()) file = find_named(kUsualScenario, search_folders(kUsualScenario));
    return load_scenario(file, {settings, std::nullopt}, modules);
  }

  ReplayResult replay(const LoadedScenario& loaded, const autopilot::Modules& modules,
                      ReplayOptions options) const override {
    return Replay(px4_.flight, loaded, modules, std::move(options)).run();
  }

  std::vector<std::string> about() const override {
    std::vector<std::string> lines{
        formatted("%s, %.1f s of IMU samples", px4_.flight.what.c_str(), to_seconds(px4_.flight.end))};
    for (const MagCandidate& mag : px4_.mags) {
      lines.push_back(
          formatted("  magnetometer %d%s: %.1f uT, spread %.1f %%, off the earth's field by %.1f %%",
                    mag.instance, px4_.mag == mag.instance ? " (taken)" : "", 1e6 * mag.strength,
                    1e2 * mag.spread, 1e2 * mag.misfit));
    }
    lines.push_back(formatted("  declination %+.2f deg (%s); fixes %.0f ms old on arrival",
                              declination_.angle * kDegrees, declination_.source.c_str(),
                              1e3 * px4_.gnss_delay));
    return lines;
  }

 private:
  Px4Flight px4_;
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
                                                  {"--start", arguments.start > 0.0}};
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

  std::vector<std::string> about() const override {
    return {formatted("%s, %.1f s", log_.flight().what.c_str(), to_seconds(log_.flight().end))};
  }

 private:
  std::filesystem::path file_;
  RunLog log_;
};

}  // namespace

std::unique_ptr<ReplaySource> ReplaySource::open(const FlightArguments& arguments) {
  if (is_mcap(arguments.flight)) return std::make_unique<RunSource>(arguments);
  return std::make_unique<Px4Source>(arguments);
}

}  // namespace ironbird::scenarios
