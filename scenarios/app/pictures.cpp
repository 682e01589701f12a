#include <memory>
#include <string>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/products.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/app/verb_options.hpp"

namespace ironbird::scenarios {

namespace {

struct VideoArguments {
  std::string log;
  std::string out = "video.mp4";
  bool preview = false;
};

struct SnapshotArguments {
  std::string log;
  std::string out = "snapshots";
};

/// Reads the log of a run, and says what it no longer tells.
Log read_log(const std::string& file, TerminalListener& listener) {
  Log log = read_flown(file);
  if (const std::string lost = what_is_lost(log); !lost.empty()) listener.note(file + ": warning: " + lost);
  return log;
}

int video(const VideoArguments& arguments) {
  note_interrupts();
  TerminalListener listener(Terminal::of_standard_error());
  const Log log = read_log(arguments.log, listener);
  const bool whole =
      make_video(log, scene_of(log, arguments.log), arguments.out, arguments.preview, listener);
  if (whole) listener.note(arguments.out);
  return whole ? kExitPass : kExitInterrupted;
}

int snapshot(const SnapshotArguments& arguments) {
  TerminalListener listener(Terminal::of_standard_error());
  const Log log = read_log(arguments.log, listener);
  for (const auto& file : make_snapshots(log, scene_of(log, arguments.log), arguments.out, listener)) {
    listener.note(file.string());
  }
  return kExitPass;
}

}  // namespace

Verb video_verb() {
  return {"video", "make the film of a log", [](VerbOptions& options) {
            auto arguments = std::make_shared<VideoArguments>();
            options.option("log", arguments->log, "flight.mcap of a run").required();
            options.option("--out", arguments->out, "file to write, .mp4 or .y4m").shows_default();
            options.flag("--preview", arguments->preview, "quicker and plainer pictures");
            options.footer("Example:\n  ironbird video out/three_waypoints/flight.mcap --out mission.mp4");
            return [arguments](const autopilot::Modules&) { return video(*arguments); };
          }};
}

Verb snapshot_verb() {
  return {"snapshot", "take the pictures that a log's scenario names", [](VerbOptions& options) {
            auto arguments = std::make_shared<SnapshotArguments>();
            options.option("log", arguments->log, "flight.mcap of a run").required();
            options.option("--out", arguments->out, "folder for the pictures").shows_default();
            options.footer("Example:\n  ironbird snapshot out/three_waypoints/flight.mcap");
            return [arguments](const autopilot::Modules&) { return snapshot(*arguments); };
          }};
}

}  // namespace ironbird::scenarios
