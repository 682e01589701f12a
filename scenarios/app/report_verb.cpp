#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/report/report.hpp"

namespace ironbird::scenarios {

namespace {

struct ReportArguments {
  std::vector<std::string> logs;
  std::string out = "report.html";
};

int report(const ReportArguments& arguments) {
  std::vector<ReportRun> runs;
  for (const std::string& file : arguments.logs) {
    const std::filesystem::path log = file;
    const std::filesystem::path folder = log.parent_path();
    const std::filesystem::path verdict = folder / "verdict.json";
    for (const auto& [read, what] : {std::pair(log, "log "), std::pair(verdict, "verdict ")}) {
      std::error_code not_there;
      if (!std::filesystem::equivalent(read, arguments.out, not_there)) continue;
      throw ConfigError("--out " + arguments.out + ": is the " + what + read.string() +
                        " itself; name another file, for example report.html");
    }
    runs.push_back(
        ReportRun::read(folder.empty() ? log.stem().string() : folder.filename().string(), log, verdict));
    for (const std::string& note : runs.back().notes())
      std::fprintf(stderr, "%s: warning: %s\n", file.c_str(), note.c_str());
  }
  write_report(runs, arguments.out);
  std::fprintf(stderr, "%s\n", arguments.out.c_str());
  return kExitPass;
}

}  // namespace

Verb report_verb() {
  return {
      "report", "make one HTML page of one log or several", [](VerbOptions& options) {
        auto arguments = std::make_shared<ReportArguments>();
        options.option("logs", arguments->logs, "logs; a verdict.json beside a log is shown too").required();
        options.option("--out", arguments->out, "file to write").shows_default();
        options.footer(
            "Examples:\n"
            "  ironbird report out/three_waypoints/flight.mcap\n"
            "  ironbird report out/three_waypoints/flight.mcap out/three_waypoints_ode/flight.mcap --out "
            "both.html");
        return [arguments](const autopilot::Modules&) { return report(*arguments); };
      }};
}

}  // namespace ironbird::scenarios
