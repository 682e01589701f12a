#include "scenarios/app/run_summary.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/config/one_line.hpp"
#include "scenarios/config/write_file.hpp"
#include "scenarios/report/junit.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

/// The gravest first.
constexpr std::array<int, 7> kByGravity = {kExitInterrupted, kExitInternal,     kExitUsage, kExitHardware,
                                           kExitFail,        kExitInconclusive, kExitPass};

/// The figures that are shown of several runs.
constexpr std::array<std::string_view, 8> kSummarised = {
    "path_rms_total_m",          "true_path_rms_total_m",     "tracking_rms_total_m",
    "estimate_horizontal_rms_m", "estimate_velocity_rms_mps", "estimate_roll_pitch_rms_deg",
    "estimate_heading_rms_deg",  "real_time_factor"};

std::string line(const RunResult& result) {
  const std::string name = result.name.text() + ": ";
  if (!result.verdict) return name + "no verdict, exit code " + std::to_string(result.exit_code) + "\n";
  const std::string trouble = result.error.empty() ? "" : ", exit code " + std::to_string(result.exit_code);
  return name + std::string(name_of(result.verdict->outcome)) + trouble + "\n";
}

using Runs = std::vector<const RunResult*>;

/// The runs of each scenario, in the order in which the scenarios come first.
std::vector<std::pair<std::string, Runs>> by_scenario(const std::vector<RunResult>& results) {
  std::vector<std::pair<std::string, Runs>> groups;
  for (const RunResult& result : results) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& known) { return known.first == result.name.scenario; });
    if (group == groups.end()) group = groups.insert(group, {result.name.scenario, {}});
    group->second.push_back(&result);
  }
  return groups;
}

std::vector<double> sorted_values(const Runs& runs, std::string_view metric) {
  std::vector<double> values;
  for (const RunResult* run : runs) {
    if (!run->verdict || run->verdict->outcome == Outcome::kInvalid) continue;  // nothing can be said of it
    for (const Metric& candidate : run->verdict->metrics) {
      if (candidate.name == metric && std::isfinite(candidate.value)) values.push_back(candidate.value);
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

bool passed(const RunResult* run) {
  return run->verdict && run->verdict->outcome == Outcome::kPass;
}

std::string statistics(const std::string& scenario, const Runs& runs) {
  std::string text = "\n" + scenario + ": " +
                     std::to_string(std::count_if(runs.begin(), runs.end(), passed)) + " of " +
                     std::to_string(runs.size()) + " runs pass\n";
  char row[160];
  std::snprintf(row, sizeof row, "  %-28s %10s %10s %10s\n", "", "least", "median", "greatest");
  text += row;
  for (const std::string_view metric : kSummarised) {
    const std::vector<double> values = sorted_values(runs, metric);
    if (values.empty()) continue;
    std::snprintf(row, sizeof row, "  %-28s %10.4g %10.4g %10.4g\n", std::string(metric).c_str(),
                  values.front(), median(values), values.back());
    text += row;
  }
  return text;
}

}  // namespace

int exit_code_of(const std::vector<RunResult>& results) {
  for (const int code : kByGravity) {
    if (std::any_of(results.begin(), results.end(), [&](const RunResult& r) { return r.exit_code == code; }))
      return code;
  }
  return kExitInternal;
}

double median(std::span<const double> sorted) {
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 != 0 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

std::string summary_text(const std::vector<RunResult>& results) {
  std::string text = "\n";
  for (const RunResult& result : results) text += line(result);
  for (const auto& [scenario, runs] : by_scenario(results)) {
    if (runs.size() > 1) text += statistics(scenario, runs);
  }
  return text;
}

std::string summary_json(const std::vector<RunResult>& results) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const RunResult& result : results) {
    if (result.verdict) {
      all.push_back(nlohmann::ordered_json::parse(to_json(*result.verdict)));
      if (!result.error.empty()) all.back()["error"] = result.error;
      continue;
    }
    nlohmann::ordered_json run = {{"scenario", result.name.scenario}};
    if (result.name.seed) run["seed"] = *result.name.seed;
    run["folder"] = result.name.folder.string();
    run["exit_code"] = result.exit_code;
    run["error"] = result.error;
    all.push_back(std::move(run));
  }
  return all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write_junit_file(const std::vector<RunResult>& results, const std::filesystem::path& file) {
  std::vector<JunitRun> runs;
  for (const RunResult& result : results) {
    runs.push_back({result.name.text(), result.verdict, on_one_line(result.error)});
  }
  write_file(file, junit_xml(runs));
}

}  // namespace ironbird::scenarios
