#include "scenarios/replay/px4_phases.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

constexpr std::int64_t kArmed = 2;

/// PX4's word for its navigation state.
std::string mode_name(std::int64_t state) {
  constexpr std::array<std::pair<std::int64_t, const char*>, 19> kNames{{{0, "manual"},
                                                                         {1, "altitude"},
                                                                         {2, "position"},
                                                                         {3, "mission"},
                                                                         {4, "hold"},
                                                                         {5, "return"},
                                                                         {6, "slow position"},
                                                                         {10, "acro"},
                                                                         {12, "descend"},
                                                                         {13, "termination"},
                                                                         {14, "offboard"},
                                                                         {15, "stabilized"},
                                                                         {16, "rattitude"},
                                                                         {17, "take-off"},
                                                                         {18, "land"},
                                                                         {19, "follow"},
                                                                         {20, "precision land"},
                                                                         {21, "orbit"},
                                                                         {22, "vtol take-off"}}};
  const auto found =
      std::find_if(kNames.begin(), kNames.end(), [state](const auto& name) { return name.first == state; });
  return found == kNames.end() ? "mode " + std::to_string(state) : found->second;
}

/// A record of either topic, by the time from which it holds.
struct Change {
  Time when{};
  std::size_t record = 0;
  bool is_status = false;
};

void add_changes(std::vector<Change>& changes, const Px4Log& log, const Px4Records& records, bool is_status) {
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Time when = records.published(k);
    if (when <= log.end) changes.push_back({std::max(when, Time::zero()), k, is_status});
  }
}

bool is_same(const RecordedPhase& one, const RecordedPhase& other) {
  return one.armed == other.armed && one.airborne == other.airborne && one.mode == other.mode;
}

}  // namespace

std::vector<RecordedPhase> read_px4_phases(const Px4Log& log) {
  const Px4Records status = log.records("vehicle_status");
  const Px4Records detected = log.records("vehicle_land_detected");
  const auto arming = status.find("arming_state");
  const auto mode = status.find("nav_state");
  const auto landed = detected.find("landed");
  std::vector<Change> changes;
  if (arming || mode) add_changes(changes, log, status, true);
  if (landed) add_changes(changes, log, detected, false);
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& one, const Change& other) { return one.when < other.when; });
  std::vector<RecordedPhase> phases;
  RecordedPhase now;
  for (const Change& change : changes) {
    now.stamp = change.when;
    if (!change.is_status) {
      now.airborne = detected.integer(change.record, landed) == 0;
      now.armed = now.armed || (!arming && now.airborne);
    } else {
      now.armed = status.integer(change.record, arming) == kArmed;
      if (mode) now.mode = mode_name(status.integer(change.record, mode));
    }
    if (!phases.empty() && phases.back().stamp == now.stamp) phases.pop_back();
    if (phases.empty() || !is_same(phases.back(), now)) phases.push_back(now);
  }
  return phases;
}

}  // namespace ironbird::scenarios
