#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
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
#include "scenarios/config/degrees.hpp"
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
  std::vector<std::string> compare;
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
  constexpr double kMost = 1e6;  // s
  if (!begin || !end || *begin >= *end || std::abs(*begin) > kMost || std::abs(*end) > kMost)
    throw ConfigError("--window " + text + ": must be BEGIN:END in seconds, for example 4.8:76.1");
  return Interval{from_seconds(*begin), from_seconds(*end)};
}

/// The declination to fly with, rad, and where it is from.
struct Declination {
  double angle = 0.0;
  std::string source;
};

Declination declination_of(const ReplayArguments& arguments, const Px4Flight& px4,
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

LoadedScenario load(const ReplayArguments& arguments, const Variant& variant, const Declination& declination,
                    const autopilot::Modules& modules) {
  std::vector<std::string> wanted = arguments.settings;
  wanted.insert(wanted.end(), variant.settings.begin(), variant.settings.end());
  std::vector<std::pair<std::string, std::string>> settings;
  if (!arguments.vehicle.empty()) settings.emplace_back("vehicle", arguments.vehicle);
  settings.emplace_back("environment.magnetic_field.declination",
                        std::to_string(declination.angle * kDegrees) + " deg");
  for (auto& setting : split_settings(wanted)) settings.push_back(std::move(setting));
  std::filesystem::path file = variant.scenario;
  if (file.empty()) file = arguments.scenario;
  if (file.empty()) file = find_named(kUsualScenario, search_folders(kUsualScenario));
  return load_scenario(file, {settings, std::nullopt}, modules);
}

void tell_flight(const Px4Flight& px4, const Declination& declination, const Interval& window) {
  std::fprintf(stderr, "%s, %.1f s of IMU samples\n", px4.flight.what.c_str(), to_seconds(px4.flight.end));
  for (const MagCandidate& mag : px4.mags) {
    std::fprintf(stderr, "  magnetometer %d%s: %.1f uT, spread %.1f %%, off the earth's field by %.1f %%\n",
                 mag.instance, px4.mag == mag.instance ? " (taken)" : "", 1e6 * mag.strength,
                 1e2 * mag.spread, 1e2 * mag.misfit);
  }
  std::fprintf(stderr,
               "  declination %+.2f deg (%s); fixes %.0f ms old on arrival; compared from %.1f to %.1f s\n",
               declination.angle * kDegrees, declination.source.c_str(), 1e3 * px4.gnss_delay,
               to_seconds(window.begin), to_seconds(window.end));
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
        name_(std::filesystem::path(arguments.flight).stem().string()),
        folder_(std::filesystem::path(arguments.out) / name_) {
    for (const std::string& bound : arguments.bounds) bounds_.push_back(parse_replay_bound(bound));
    Px4Choice choice;
    if (arguments.mag != kUnnamed) choice.mag = arguments.mag;
    if (arguments.gnss_delay >= 0.0) choice.gnss_delay = arguments.gnss_delay;
    px4_ = read_px4_flight(UlogFile::read(arguments.flight), arguments.flight, choice);
    declination_ = declination_of(arguments, px4_, px4_.flight.remarks);
  }

  Replayed run(const Variant& variant, RunListener& listener) const {
    const LoadedScenario loaded = load(arguments_, variant, declination_, modules_);
    const std::string name = variant.name.empty() ? name_ : name_ + ", " + variant.name;
    Replayed done{variant, variant.name.empty() ? folder_ : folder_ / variant.name, {}, {}};
    const RunFolder held(done.folder);
    ReplayOptions options;
    options.window = window_;
    if (!arguments_.no_log) options.log_file = done.folder / "flight.mcap";
    const double length = to_seconds(px4_.flight.end);
    options.on_progress = [&](Time now) {
      listener.progress({name, to_seconds(now), length, "replayed"});
      return !interrupt_requested();
    };
    done.result = Replay(px4_.flight, loaded, modules_, options).run();
    done.verdict = judge_replay(done.result,
                                {name, loaded.scenario.title, loaded.scenario.seed, loaded.digest}, bounds_);
    write_verdict(done.verdict, done.folder / "verdict.json");
    listener.judged(done.verdict);
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

  void tell(const std::vector<Replayed>& all) const {
    tell_flight(px4_, declination_, all.front().result.window);
    tell_figures(all);
  }

 private:
  const ReplayArguments& arguments_;
  const autopilot::Modules& modules_;
  std::optional<Interval> window_;
  std::string name_;
  std::filesystem::path folder_;
  std::vector<ReplayBound> bounds_;
  Px4Flight px4_;
  Declination declination_;
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
  const std::vector<Variant> variants = variants_of(arguments);
  const ReplayWork work(arguments, modules);
  TerminalListener listener(Terminal::of_standard_error());
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
        options
            .option("--compare", arguments->compare,
                    "two or more side by side: kinds of estimator, settings PATH=VALUE, or scenarios")
            .called("A B");
        options.option("--out", arguments->out, "folder for the results").shows_default();
        options.flag("--no-log", arguments->no_log, "write no log and no report, only the verdict");
        options.flag("--no-report", arguments->no_report, "write no report");
        options.flag("--json", arguments->json, "the verdict as JSON on standard output");
        options.footer(
            "Examples:\n"
            "  ironbird replay flight.ulg\n"
            "  ironbird replay flight.ulg --set autopilot.estimator.kind=error_state\n"
            "  ironbird replay flight.ulg --compare ekf error_state\n"
            "  ironbird replay flight.ulg --mag 1 --window 5:60 --at-most horizontal_difference_rms_m=0.25");
        return [arguments](const autopilot::Modules& modules) { return replay(*arguments, modules); };
      }};
}

}  // namespace ironbird::scenarios
