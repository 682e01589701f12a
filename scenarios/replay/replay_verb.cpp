#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/products.hpp"
#include "scenarios/app/run_folder.hpp"
#include "scenarios/app/scenario_arguments.hpp"
#include "scenarios/app/scene.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/replay/provenance.hpp"
#include "scenarios/replay/replay_sources.hpp"
#include "scenarios/replay/replay_verdict.hpp"
#include "scenarios/replay/run_log.hpp"
#include "scenarios/report/report.hpp"
#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

struct ReplayArguments {
  FlightArguments flight;
  std::string scenario;
  std::string vehicle;
  std::vector<std::string> settings;
  std::string window;
  std::vector<std::string> bounds;
  std::vector<std::string> compare;
  std::string out = "out";
  bool no_log = false;
  bool no_report = false;
  bool video = false;
  bool json = false;
};

std::optional<Interval> window_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t colon = text.find(':');
  const auto begin = number_of(text.substr(0, colon));
  const auto end = colon == std::string::npos ? std::nullopt : number_of(text.substr(colon + 1));
  constexpr double kMost = 1e6;  // s
  if (!begin || !end || *begin >= *end || std::abs(*begin) > kMost || std::abs(*end) > kMost)
    throw ConfigError("--window " + text + ": must be BEGIN:END in seconds, for example 4.8:76.1");
  return Interval{from_seconds(*begin), from_seconds(*end)};
}

/// One of the estimators, or sets of parameters, that a flight is fed to.
struct Variant {
  std::string name;                   ///< empty: there is one only
  std::filesystem::path scenario;     ///< empty: the usual one
  std::vector<std::string> settings;  ///< on top of those for all
};

/// What `--compare` names: a scenario, a setting, or a kind of estimator.
Variant variant_of(const std::string& word) {
  Variant variant{word, {}, {}};
  if (std::filesystem::path(word).extension() == ".toml") {
    variant.name = std::filesystem::path(word).stem().string();
    variant.scenario = word;
  } else {
    variant.settings.push_back(word.find('=') != std::string::npos ? word
                                                                   : "autopilot.estimator.kind=" + word);
    std::replace(variant.name.begin(), variant.name.end(), '/', '_');
  }
  return variant;
}

std::vector<Variant> variants_of(const ReplayArguments& arguments) {
  if (arguments.compare.empty()) return {Variant{{}, {}, {}}};
  std::vector<Variant> variants;
  std::set<std::string> names;
  for (const std::string& word : arguments.compare) {
    variants.push_back(variant_of(word));
    if (!names.insert(variants.back().name).second)
      throw ConfigError("--compare " + word + ": is named twice");
  }
  if (variants.size() < 2)
    throw ConfigError("--compare: must name two or more, for example --compare ekf error_state");
  return variants;
}

using Settings = std::vector<std::pair<std::string, std::string>>;

/// Does a setting change the column map, and not the scenario?
bool is_of_map(const std::pair<std::string, std::string>& setting) {
  return setting.first.starts_with("map.");
}

Settings map_settings_of(const ReplayArguments& arguments) {
  Settings settings = split_settings(arguments.settings);
  std::erase_if(settings, [](const auto& setting) { return !is_of_map(setting); });
  return settings;
}

PilotChoice choice_of(const ReplayArguments& arguments, const Variant& variant) {
  std::vector<std::string> wanted = arguments.settings;
  wanted.insert(wanted.end(), variant.settings.begin(), variant.settings.end());
  PilotChoice choice{variant.scenario, {}};
  if (choice.scenario.empty()) choice.scenario = arguments.scenario;
  if (!arguments.vehicle.empty()) choice.settings.emplace_back("vehicle", arguments.vehicle);
  for (auto& setting : split_settings(wanted)) {
    if (!is_of_map(setting)) choice.settings.push_back(std::move(setting));
  }
  return choice;
}

/// The log of a run has the name of all others, its folder that of the scenario.
std::string name_of_flight(const std::filesystem::path& file) {
  if (!is_mcap(file)) return file.stem().string();
  std::error_code ignored;
  const std::filesystem::path real = std::filesystem::weakly_canonical(file, ignored);
  const bool usual = real.stem() == "flight" && real.has_parent_path();
  return (usual ? real.parent_path().filename() : real.stem()).string() + "_replayed";
}

/// A flight that was flown is not written over by one that is replayed.
void require_no_flown(const std::filesystem::path& log) {
  std::error_code ignored;
  if (!std::filesystem::exists(log, ignored)) return;
  bool replayed = false;
  try {
    const McapReader reader(log);
    const auto run = reader.metadata().find("run");
    replayed = run != reader.metadata().end() && run->second.contains("recorded");
  } catch (const UserError&) {  // whatever it is, it is nobody's replay
  }
  if (!replayed)
    throw ConfigError(log.string() + ": is no replay's and would be lost; name another folder with --out");
}

/// What came of one variant.
struct Replayed {
  Variant variant;
  std::filesystem::path folder;
  ReplayResult result;
  Verdict verdict;
};

/// The figures of all variants beside each other.
void tell_figures(const std::vector<Replayed>& all) {
  if (all.size() > 1) {
    std::fprintf(stderr, "  %-30s", "");
    for (const Replayed& one : all) std::fprintf(stderr, " %16s", one.variant.name.c_str());
    std::fputs("\n", stderr);
  }
  for (std::size_t k = 0; k < all.front().result.metrics.size(); ++k) {
    const Metric& metric = all.front().result.metrics[k];
    std::fprintf(stderr, "  %-30s", metric.name.c_str());
    for (const Replayed& one : all)
      std::fprintf(stderr, all.size() > 1 ? " %16.3f" : " %8.3f", one.result.metrics[k].value);
    std::fprintf(stderr, " %s\n", metric.unit.c_str());
  }
}

/// Everything that the variants of one flight share.
class ReplayWork {
 public:
  ReplayWork(const ReplayArguments& arguments, const autopilot::Modules& modules)
      : arguments_(arguments),
        modules_(modules),
        window_(window_of(arguments.window)),
        name_(name_of_flight(arguments.flight.flight)),
        folder_(std::filesystem::path(arguments.out) / name_) {
    for (const std::string& bound : arguments.bounds) bounds_.push_back(parse_replay_bound(bound));
    source_ = ReplaySource::open(arguments.flight, map_settings_of(arguments));
    check_times();
  }

  /// Finds out before anything is written whether it can be done.
  /// @throws UserError, ConfigError
  LoadedScenario load(const Variant& variant) const {
    LoadedScenario loaded = source_->load(choice_of(arguments_, variant), modules_);
    if (arguments_.video) check_scene(loaded);
    require_no_flown(folder_of(variant) / "flight.mcap");
    return loaded;
  }

  Replayed run(const Variant& variant, RunListener& listener) const {
    const LoadedScenario loaded = load(variant);
    const std::string name = variant.name.empty() ? name_ : name_ + ", " + variant.name;
    Replayed done{variant, folder_of(variant), {}, {}};
    const RunFolder held(done.folder);
    remove_old_products(done.folder);
    ReplayOptions options;
    options.window = window_;
    options.start = from_seconds(arguments_.flight.start);
    if (!arguments_.no_log) options.log_file = done.folder / "flight.mcap";
    const double length = to_seconds(source_->flight().end);
    options.on_progress = [&](Time now) {
      listener.progress({name, to_seconds(now), length, "replayed"});
      return !interrupt_requested();
    };
    try {
      done.result = source_->replay(loaded, modules_, options);
    } catch (...) {  // half a log would be taken for a flight
      std::error_code ignored;
      std::filesystem::remove(options.log_file, ignored);
      throw;
    }
    done.verdict = judge_replay(done.result,
                                {name, loaded.scenario.title, loaded.scenario.seed, loaded.digest}, bounds_);
    done.verdict.flight = source_->provenance();
    done.verdict.flight->file = std::filesystem::path(arguments_.flight.flight).filename().string();
    note_window(*done.verdict.flight, source_->flight(), done.result.window, window_.has_value());
    write_verdict(done.verdict, done.folder / "verdict.json");
    listener.judged(done.verdict);
    if (arguments_.video) done.result.interrupted |= !film(done, loaded, listener);
    return done;
  }

  void report(const std::vector<Replayed>& all) const {
    std::vector<ReportRun> runs;
    for (const Replayed& one : all) {
      runs.push_back(ReportRun::read(one.variant.name.empty() ? name_ : one.variant.name,
                                     one.folder / "flight.mcap", one.folder / "verdict.json"));
    }
    write_report(runs, folder_ / "report.html");
  }

  /// @return false when it was interrupted
  static bool film(const Replayed& done, const LoadedScenario& loaded, RunListener& listener) {
    if (done.result.interrupted) return true;
    if (!done.result.ready) {
      listener.note("no film: there was no estimate to show");
      return true;
    }
    const Log log = Log::read(done.folder / "flight.mcap");
    return make_video(log, scene_of(loaded), done.folder / "video.mp4", false, listener);
  }

  void tell(const std::vector<Replayed>& all) const {
    for (const std::string& line : source_->about()) std::fprintf(stderr, "%s\n", line.c_str());
    const Interval& window = all.front().result.window;
    std::fprintf(stderr, "  compared from %.1f to %.1f s with %s\n", to_seconds(window.begin),
                 to_seconds(window.end), compared_with().c_str());
    tell_figures(all);
  }

 private:
  std::filesystem::path folder_of(const Variant& variant) const {
    return variant.name.empty() ? folder_ : folder_ / variant.name;
  }

  void check_times() const {
    const RecordedFlight& flight = source_->flight();
    const double end = to_seconds(flight.end);
    const std::string ends = ": the flight ends at " + with_unit(end, "s");
    if (arguments_.flight.start >= end)
      throw ConfigError("--start " + with_unit(arguments_.flight.start, "s") + ends);
    if (window_ && window_->begin >= flight.end) throw ConfigError("--window " + arguments_.window + ends);
    if (window_ && window_->end <= from_seconds(arguments_.flight.start))
      throw ConfigError("--window " + arguments_.window + ": ends before --start");
  }

  std::string compared_with() const {
    const auto& estimates = source_->flight().estimates;
    return estimates.empty() ? "nothing: no estimate was recorded" : estimates.front().name;
  }

  const ReplayArguments& arguments_;
  const autopilot::Modules& modules_;
  std::optional<Interval> window_;
  std::string name_;
  std::filesystem::path folder_;
  std::vector<ReplayBound> bounds_;
  std::unique_ptr<ReplaySource> source_;
};

/// A failure outweighs what is inconclusive.
int exit_code_of_all(const std::vector<Replayed>& all) {
  int code = kExitPass;
  for (const Replayed& one : all) {
    if (one.result.interrupted) return kExitInterrupted;
    const int its = exit_code(one.verdict.outcome);
    if (code == kExitPass || its == kExitFail) code = its;
  }
  return code;
}

int replay(const ReplayArguments& arguments, const autopilot::Modules& modules) {
  note_interrupts();
  if (arguments.no_log && arguments.video)
    throw ConfigError("--no-log: the film is made from the log; leave one of the options away");
  const std::vector<Variant> variants = variants_of(arguments);
  const ReplayWork work(arguments, modules);
  TerminalListener listener(Terminal::of_standard_error());
  for (const Variant& variant : variants) work.load(variant);
  std::vector<Replayed> all;
  for (const Variant& variant : variants) all.push_back(work.run(variant, listener));
  work.tell(all);
  if (!arguments.no_log && !arguments.no_report) work.report(all);
  if (arguments.json) {
    std::string text;
    for (const Replayed& one : all) text += (text.empty() ? "" : ",\n") + to_json(one.verdict);
    std::fputs((all.size() > 1 ? "[" + text + "]\n" : text).c_str(), stdout);
  }
  return exit_code_of_all(all);
}

}  // namespace

Verb replay_verb() {
  return {
      "replay", "feed a recorded flight to the estimators", [](VerbOptions& options) {
        auto arguments = std::make_shared<ReplayArguments>();
        FlightArguments& flight = arguments->flight;
        options
            .option(
                "flight", flight.flight,
                "log of a PX4 autopilot, FLIGHT.ulg, or of a run of ours, flight.mcap; or column map of a "
                "flight in tables, MAP.toml")
            .required();
        options.option("--data", flight.data, "folder of the tables of a column map; else the map's own");
        options.option("--vehicle", arguments->vehicle, "folder of the vehicle whose autopilot stands in");
        options.option("--scenario", arguments->scenario,
                       "which autopilot, with which parameters; its flight is not flown");
        options.option("--set", arguments->settings, "changes the scenario; may be repeated")
            .one_word_each()
            .called("PATH=VALUE");
        options
            .option("--mag", flight.mag,
                    "instance of the magnetometer; else the one that fits the earth's field best")
            .within(0, 255);
        options.option("--declination", flight.declination,
                       "deg, east positive; else by the World Magnetic Model");
        options.option(
            "--window", arguments->window,
            "what is compared, BEGIN:END in seconds; else the flight without take-off and landing");
        options
            .option("--start", flight.start,
                    "leave out what was recorded before, s: begins in the air, perhaps")
            .within(0.0, 1e6);
        options
            .option("--gnss-delay", flight.gnss_delay,
                    "age of a fix on arrival, s; else as the log's parameters say")
            .within(0.0, 1.0);
        options.option("--at-most", arguments->bounds, "a figure that must not be greater; may be repeated")
            .one_word_each()
            .called("NAME=VALUE");
        options
            .option("--compare", arguments->compare,
                    "two or more side by side: kinds of estimator, settings PATH=VALUE, or scenarios")
            .called("A B");
        options.option("--out", arguments->out, "folder for the results").shows_default();
        options.flag("--no-log", arguments->no_log, "write no log and no report, only the verdict");
        options.flag("--no-report", arguments->no_report, "write no report");
        options.flag("--video", arguments->video,
                     "make video.mp4: the vehicle by our estimate, the recorded one as its ghost");
        options.flag("--json", arguments->json, "the verdict as JSON on standard output");
        options.footer(
            "Examples:\n"
            "  ironbird replay flight.ulg\n"
            "  ironbird replay out/three_waypoints/flight.mcap --out again\n"
            "  ironbird replay flight.ulg --set autopilot.estimator.kind=error_state\n"
            "  ironbird replay flight.ulg --compare ekf error_state\n"
            "  ironbird replay columns.toml --data tables --set map.made.seed=2\n"
            "  ironbird replay flight.ulg --mag 1 --window 5:60 --at-most horizontal_difference_rms_m=0.25");
        return [arguments](const autopilot::Modules& modules) { return replay(*arguments, modules); };
      }};
}

}  // namespace ironbird::scenarios
