#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "scenarios/bench/flight_log.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/replay/comparison.hpp"
#include "scenarios/replay/recorded_flight.hpp"
#include "scenarios/requirements/check.hpp"

namespace ironbird::scenarios {

/// What a replay does beside estimating.
struct ReplayOptions {
  std::filesystem::path log_file;  ///< empty: no log
  std::optional<Interval> window;  ///< what counts; none: airborne, without take-off and landing
  hil_bridge::Time start{};        ///< what came before is left out, as if the recorder had been started then
  std::function<bool(hil_bridge::Time)> on_progress;  ///< asked every second of the flight; false: stop
};

/// What came of it.
struct ReplayResult {
  std::vector<Metric> metrics;
  Interval window;
  std::vector<std::string> remarks;
  std::optional<double> ready;
  std::optional<CheckResult> same;
  bool lost_at_end = false;
  bool interrupted = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("metrics", self.metrics, "", "how far ours is from the recorded one");
    visit("window", self.window, "", "what was compared");
    visit("remarks", self.remarks, "", "what was not as it should be, a line each");
    visit("ready", self.ready, "s", "when there was an estimate; none: never");
    visit("same", self.same, "", "the autopilot computes what it computed then; none: it need not");
    visit("lost_at_end", self.lost_at_end, "1", "the estimator says that it is lost");
    visit("interrupted", self.interrupted, "1", "somebody asked to stop");
  }
};

/// The window that counts unless another is named: from three seconds after the first take-off to a second
/// before the last landing; the whole flight when nobody told of either.
/// @param start  of the replay, three seconds after which nothing counts yet either
Interval usual_window(const RecordedFlight& flight, hil_bridge::Time start = {});

/// Feeds what was recorded in a flight to an autopilot, through the same door as a unit's messages, and holds
/// its estimate against what was estimated then. What it commands goes nowhere.
class Replay {
 public:
  /// @param flight, loaded  outlive this
  /// @throws std::invalid_argument when the autopilot cannot be wired, std::runtime_error when the log cannot
  /// be made
  Replay(const RecordedFlight& flight, const LoadedScenario& loaded, const autopilot::Modules& modules,
         ReplayOptions options);

  /// From the first message to the last. Called once.
  ReplayResult run();

  // Piece by piece, for flights that hold other things than messages.

  /// One frame of the flight, and what was recorded up to `now`.
  void step(const autopilot::SensorFrame& frame, hil_bridge::Time now);
  /// What was asked of the autopilot between two frames.
  autopilot::RequestOutcome request(const autopilot::Request& request, hil_bridge::Time now);
  /// Whoever waits for it has not had enough. To be asked after each frame.
  bool goes_on(hil_bridge::Time now);
  /// What came of it. Called once, last.
  ReplayResult finish();

  const autopilot::Autopilot& autopilot() const { return *autopilot_; }
  /// What the log shows of the unit.
  hil_bridge::Telemetry& telemetry() { return telemetry_; }
  /// Null: none is written.
  FlightLog* log() { return log_.get(); }

 private:
  void wire_log(const LoadedScenario& loaded);
  /// What was recorded, in the frame of the estimate that is made now.
  void write_recorded(const autopilot::SensorFrame& frame, hil_bridge::Time now);
  void watch_health();
  void note_doubts(const autopilot::StateEstimate& estimate);
  std::vector<std::string> findings() const;

  const RecordedFlight& flight_;
  ReplayOptions options_;
  Interval window_;
  std::unique_ptr<autopilot::Autopilot> autopilot_;
  hil_bridge::Telemetry telemetry_;
  std::unique_ptr<FlightLog> log_;        // null: none is wanted
  std::optional<Comparison> comparison_;  // none: there is nothing to compare with
  std::size_t next_attitude_ = 0;
  std::size_t next_position_ = 0;
  std::size_t next_phase_ = 0;
  bool origin_written_ = false;
  std::optional<hil_bridge::Time> ready_;  // when there was an estimate
  hil_bridge::Time next_progress_{};
  std::optional<hil_bridge::Time> seen_;  // the newest estimate
  hil_bridge::Time degraded_{};
  hil_bridge::Time doubtful_{};
  hil_bridge::Time unknown_{};
  int losses_ = 0;
  bool lost_ = false;
  bool interrupted_ = false;
};

}  // namespace ironbird::scenarios
