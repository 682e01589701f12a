#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/run_folder.hpp"
#include "scenarios/app/scenario_arguments.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/config/file_search.hpp"
#include "scenarios/replay/magnetic_field.hpp"
#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/replay/replay.hpp"
#include "scenarios/replay/replay_verdict.hpp"
#include "scenarios/report/report.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kUsualScenario = "scenarios/replay/recorded_flight.toml";
constexpr int kUnnamed = -1;

struct ReplayArguments {
  std::string flight;
  std::string scenario;
  std::string vehicle;
  std::vector<std::string> settings;
  int mag = kUnnamed;
  std::string declination;  // deg
  std::string window;
  double gnss_delay = -1.0;  // s
  std::vector<std::string> bounds;
  std::string out = "out";
  bool no_log = false;
  bool no_report = false;
  bool json = false;
};

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<Interval> window_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t colon = text.find(':');
  const auto begin = number_of(text.substr(0, colon));
  const auto end = colon == std::string::npos ? std::nullopt : number_of(text.substr(colon + 1));
  if (!begin || !end || *begin >= *end)
    throw ConfigError("--window " + text + ": must be BEGIN:END in seconds, for example 4.8:76.1");
  return Interval{from_seconds(*begin), from_seconds(*end)};
}

/// The declination to fly with, rad, and where it is from.
struct Declination {
  double angle = 0.0;
  std::string source;
};

/// Where and when the flight began, for the field of the earth.
std::optional<hil_bridge::rosflight::RosflightGnss> first_fix(const RecordedFlight& flight) {
  for (const hil_bridge::Arrival& arrival : flight.messages) {
    const auto* fix = std::get_if<hil_bridge::rosflight::RosflightGnss>(&arrival.message);
    if (fix != nullptr && autopilot::is_usable(static_cast<autopilot::GnssFix>(fix->fix_type))) return *fix;
  }
  return std::nullopt;
}

Declination declination_of(const ReplayArguments& arguments, const Px4Flight& px4,
                           std::vector<std::string>& remarks) {
  if (!arguments.declination.empty()) {
    const auto named = number_of(arguments.declination);
    if (!named || std::abs(*named) > 180.0)
      throw ConfigError("--declination " + arguments.declination +
                        ": must be an angle in degrees, east positive");
    return {*named / kDegrees, "as named"};
  }
  const auto fix = first_fix(px4.flight);
  if (!fix) return {0.0, "0, for there is no place to ask for"};
  if (!px4.unix_time)
    remarks.emplace_back("its fixes do not tell the date: the declination is that of the newest model");
  constexpr double kNewest = 2025.0;
  const double year = px4.unix_time ? decimal_year(*px4.unix_time) : kNewest;
  const MagneticField field =
      magnetic_field(fix->lat / kDegrees, fix->lon / kDegrees, static_cast<double>(fix->height), year);
  if (!field.current)
    remarks.push_back(
        "no World Magnetic Model that is known is meant for its date: the declination is that of " +
        std::to_string(field.edition));
  return {field.declination, "World Magnetic Model " + std::to_string(field.edition)};
}

LoadedScenario load(const ReplayArguments& arguments, const Declination& declination,
                    const autopilot::Modules& modules) {
  std::vector<std::pair<std::string, std::string>> settings;
  if (!arguments.vehicle.empty()) settings.emplace_back("vehicle", arguments.vehicle);
  settings.emplace_back("environment.magnetic_field.declination",
                        std::to_string(declination.angle * kDegrees) + " deg");
  for (auto& setting : split_settings(arguments.settings)) settings.push_back(std::move(setting));
  std::filesystem::path file = arguments.scenario;
  if (file.empty()) file = find_named(kUsualScenario, search_folders(kUsualScenario));
  return load_scenario(file, {settings, std::nullopt}, modules);
}

void tell(const Px4Flight& px4, const Declination& declination, const ReplayResult& result) {
  std::fprintf(stderr, "%s, %.1f s of IMU samples\n", px4.flight.what.c_str(), to_seconds(px4.flight.end));
  for (const MagCandidate& mag : px4.mags) {
    std::fprintf(stderr, "  magnetometer %d%s: %.1f uT, spread %.1f %%, off the earth's field by %.1f %%\n",
                 mag.instance, mag.instance == px4.mag ? " (taken)" : "", 1e6 * mag.strength,
                 1e2 * mag.spread, 1e2 * mag.misfit);
  }
  std::fprintf(stderr,
               "  declination %+.2f deg (%s); fixes %.0f ms old on arrival; compared from %.1f to %.1f s\n",
               declination.angle * kDegrees, declination.source.c_str(), 1e3 * px4.gnss_delay,
               to_seconds(result.window.begin), to_seconds(result.window.end));
  for (const Metric& metric : result.metrics)
    std::fprintf(stderr, "  %-30s %8.3f %s\n", metric.name.c_str(), metric.value, metric.unit.c_str());
}

int replay(const ReplayArguments& arguments, const autopilot::Modules& modules) {
  note_interrupts();
  std::vector<ReplayBound> bounds;
  for (const std::string& bound : arguments.bounds) bounds.push_back(parse_replay_bound(bound));
  ReplayOptions options;
  options.window = window_of(arguments.window);
  Px4Choice choice;
  if (arguments.mag != kUnnamed) choice.mag = arguments.mag;
  if (arguments.gnss_delay >= 0.0) choice.gnss_delay = arguments.gnss_delay;
  Px4Flight px4 = read_px4_flight(UlogFile::read(arguments.flight), arguments.flight, choice);
  const Declination declination = declination_of(arguments, px4, px4.flight.remarks);
  const LoadedScenario loaded = load(arguments, declination, modules);
  const std::string name = std::filesystem::path(arguments.flight).stem().string();
  const std::filesystem::path folder = std::filesystem::path(arguments.out) / name;
  const RunFolder held(folder);
  if (!arguments.no_log) options.log_file = folder / "flight.mcap";
  TerminalListener listener(Terminal::of_standard_error());
  const double length = to_seconds(px4.flight.end);
  options.on_progress = [&](Time now) {
    listener.progress({name, to_seconds(now), length, "replayed"});
    return !interrupt_requested();
  };
  Replay work(px4.flight, loaded, modules, options);
  const ReplayResult result = work.run();
  const Verdict verdict =
      judge_replay(result, {name, loaded.scenario.title, loaded.scenario.seed, loaded.digest}, bounds);
  write_verdict(verdict, folder / "verdict.json");
  listener.judged(verdict);
  tell(px4, declination, result);
  if (!arguments.no_log && !arguments.no_report) {
    std::vector<ReportRun> runs;
    runs.push_back(ReportRun::read(name, options.log_file, folder / "verdict.json"));
    write_report(runs, folder / "report.html");
  }
  if (arguments.json) std::fputs(to_json(verdict).c_str(), stdout);
  return result.interrupted ? static_cast<int>(kExitInterrupted) : exit_code(verdict.outcome);
}

}  // namespace

Verb replay_verb() {
  return {
      "replay", "feed a recorded flight to the estimators", [](VerbOptions& options) {
        auto arguments = std::make_shared<ReplayArguments>();
        options.option("flight", arguments->flight, "log of a PX4 autopilot, FLIGHT.ulg").required();
        options.option("--vehicle", arguments->vehicle, "folder of the vehicle whose autopilot stands in");
        options.option("--scenario", arguments->scenario,
                       "which autopilot, with which parameters; its flight is not flown");
        options.option("--set", arguments->settings, "changes the scenario; may be repeated")
            .one_word_each()
            .called("PATH=VALUE");
        options
            .option("--mag", arguments->mag,
                    "instance of the magnetometer; else the one that fits the earth's field best")
            .within(0, 255);
        options.option("--declination", arguments->declination,
                       "deg, east positive; else by the World Magnetic Model");
        options.option(
            "--window", arguments->window,
            "what is compared, BEGIN:END in seconds; else the flight without take-off and landing");
        options
            .option("--gnss-delay", arguments->gnss_delay,
                    "age of a fix on arrival, s; else as the log's parameters say")
            .within(0.0, 1.0);
        options.option("--at-most", arguments->bounds, "a figure that must not be greater; may be repeated")
            .one_word_each()
            .called("NAME=VALUE");
        options.option("--out", arguments->out, "folder for the results").shows_default();
        options.flag("--no-log", arguments->no_log, "write no log and no report, only the verdict");
        options.flag("--no-report", arguments->no_report, "write no report");
        options.flag("--json", arguments->json, "the verdict as JSON on standard output");
        options.footer(
            "Examples:\n"
            "  ironbird replay flight.ulg\n"
            "  ironbird replay flight.ulg --set autopilot.estimator.kind=error_state\n"
            "  ironbird replay flight.ulg --mag 1 --window 5:60 --at-most horizontal_difference_rms_m=0.25");
        return [arguments](const autopilot::Modules& modules) { return replay(*arguments, modules); };
      }};
}

}  // namespace ironbird::scenarios
