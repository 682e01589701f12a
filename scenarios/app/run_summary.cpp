#include "scenarios/app/run_summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

/// The gravest first.
constexpr std::array<int, 7> kGravity = {kExitInterrupted, kExitInternal,     kExitUsage, kExitHardware,
                                         kExitFail,        kExitInconclusive, kExitPass};

/// The figures of which several runs show the worst.
constexpr std::array<std::string_view, 8> kSummarised = {
    "path_rms_total_m",          "true_path_rms_total_m",     "tracking_rms_total_m",
    "estimate_horizontal_rms_m", "estimate_velocity_rms_mps", "estimate_roll_pitch_rms_deg",
    "estimate_heading_rms_deg",  "real_time_factor"};

std::string line(const RunResult& result) {
  const std::string name = result.folder.string();
  if (!result.verdict) return name + ": no verdict, exit code " + std::to_string(result.exit_code) + "\n";
  return name + ": " + std::string(name_of(result.verdict->outcome)) + "\n";
}

std::vector<double> values_of(const std::vector<RunResult>& results, std::string_view metric) {
  std::vector<double> values;
  for (const RunResult& result : results) {
    if (!result.verdict) continue;
    for (const Metric& candidate : result.verdict->metrics) {
      if (candidate.name == metric && std::isfinite(candidate.value)) values.push_back(candidate.value);
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

int exit_code_of(const std::vector<RunResult>& results) {
  for (const int code : kGravity) {
    if (std::any_of(results.begin(), results.end(), [&](const RunResult& r) { return r.exit_code == code; }))
      return code;
  }
  return kExitInternal;
}

std::string summary_text(const std::vector<RunResult>& results, const Terminal&) {
  std::string text = "\n";
  for (const RunResult& result : results) text += line(result);
  char row[160];
  std::snprintf(row, sizeof row, "\n%-30s %10s %10s %10s\n", "over all runs", "least", "median", "greatest");
  text += row;
  for (const std::string_view metric : kSummarised) {
    const std::vector<double> values = values_of(results, metric);
    if (values.empty()) continue;
    std::snprintf(row, sizeof row, "%-30s %10.4g %10.4g %10.4g\n", std::string(metric).c_str(),
                  values.front(), values[values.size() / 2], values.back());
    text += row;
  }
  return text;
}

std::string summary_json(const std::vector<RunResult>& results) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const RunResult& result : results) {
    if (result.verdict) {
      all.push_back(nlohmann::ordered_json::parse(to_json(*result.verdict)));
    } else {
      all.push_back(
          {{"folder", result.folder.string()}, {"exit_code", result.exit_code}, {"error", result.error}});
    }
  }
  return all.dump(2) + "\n";
}

}  // namespace ironbird::scenarios
