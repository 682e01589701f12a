#include "scenarios/replay/run_log.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <utility>

#include "scenarios/bench/logged_request.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/mcap_format.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/replay/comparison.hpp"
#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/timeline.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

RecordedAttitude attitude_of(const simulator::Truth& truth) {
  return {truth.stamp, truth.q_NB};
}
RecordedPosition position_of(const simulator::Truth& truth) {
  return {truth.stamp, truth.p_NB_N, truth.v_NB_N};
}
RecordedAttitude attitude_of(const autopilot::StateEstimate& estimate) {
  return {estimate.stamp, estimate.q_NB};
}
RecordedPosition position_of(const autopilot::StateEstimate& estimate) {
  const bool known = estimate.position_known;
  return {estimate.stamp, estimate.p_NB_N, estimate.v_NB_N(), known, true, known};
}

/// Positions count from where the first estimate did.
void add_estimate(const autopilot::StateEstimate& estimate, RecordedEstimate& then) {
  if (!autopilot::is_usable(estimate.health)) return;
  if (!then.origin.known) then.origin = estimate.origin;
  then.attitudes.push_back(attitude_of(estimate));
  then.positions.push_back(position_of(estimate));
  RecordedPosition& position = then.positions.back();
  position.p_NB_N = seen_from(then.origin, position.p_NB_N, estimate.origin);
}

void add(const simulator::Truth& state, RecordedEstimate& estimate) {
  estimate.attitudes.push_back(attitude_of(state));
  estimate.positions.push_back(position_of(state));
}

/// From leaving the ground to coming down on it.
void note_ground(const RunEvent& event, std::vector<Interval>& airborne) {
  if (event.kind != "ground") return;
  const Time when = from_seconds(event.time);
  const bool flies = !airborne.empty() && airborne.back().end == Time::max();
  if (event.text == kLiftedOff && !flies) airborne.push_back({when, Time::max()});
  if (event.text != kLiftedOff && flies) airborne.back().end = when;
}

std::string value_of(const McapMetadata& values, const char* name) {
  const auto found = values.find(name);
  return found == values.end() ? "" : found->second;
}

}  // namespace

bool is_mcap(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, kMcapMagic.size()> head{};
  in.read(head.data(), head.size());
  return in && std::equal(head.begin(), head.end(), kMcapMagic.begin(), [](char read, std::uint8_t magic) {
           return static_cast<std::uint8_t>(read) == magic;
         });
}

RunLog RunLog::read(const std::filesystem::path& file) {
  RunLog log;
  log.path_ = file;
  log.file_ = std::make_unique<McapReader>(file);
  log.describe_flight();
  log.require<autopilot::SensorFrame>(kSensorsTopic);
  log.require<LoggedRequest>(kRequestTopic);
  log.take_recorded();
  return log;
}

void RunLog::describe_flight() {
  const auto run = file_->metadata().find("run");
  if (run == file_->metadata().end() || value_of(run->second, "config").empty()) {
    throw UserError(path_.string() +
                    ": holds no configuration: it is no log of `ironbird run`, or was cut short before it");
  }
  configuration_ = value_of(run->second, "config");
  digest_ = value_of(run->second, "digest");
  flight_.what = "Ironbird " + value_of(run->second, "version") + ", scenario " +
                 value_of(run->second, "scenario") + ", seed " + value_of(run->second, "seed");
}

template <class T>
void RunLog::require(std::string_view topic) const {
  const auto& channels = file_->channels();
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const auto& entry) { return entry.second.topic == topic; });
  const std::string without = path_.string() + ": cannot be flown again: ";
  if (found == channels.end() && file_->truncated())
    throw UserError(without + "it was cut short before its first " + std::string(topic));
  if (found == channels.end()) {
    throw UserError(without + "it has no " + std::string(topic) +
                    "; fly the scenario again, with record.frames = true");
  }
  if (!holds<T>(found->second)) {
    throw UserError(without + "its " + std::string(topic) +
                    " is of another version of Ironbird; replay it with the one that flew it (" +
                    flight_.what + ")");
  }
}

void RunLog::take_recorded() {
  RecordedEstimate truth{"truth", {}, {}, {}};
  RecordedEstimate then{"the estimate of then", {}, {}, {}};
  std::map<std::uint16_t, std::function<void(const McapMessage&)>> takers;
  for (const auto& [id, channel] : file_->channels()) {
    if (channel.topic == kTruthTopic && holds<simulator::Truth>(channel)) {
      takers[id] = [&](const McapMessage& message) { add(decode<simulator::Truth>(message), truth); };
    } else if (channel.topic == kEstimateTopic && holds<autopilot::StateEstimate>(channel)) {
      takers[id] = [&](const McapMessage& message) {
        add_estimate(decode<autopilot::StateEstimate>(message), then);
      };
    } else if (channel.topic == kEventTopic && holds<RunEvent>(channel)) {
      takers[id] = [&](const McapMessage& message) {
        note_ground(decode<RunEvent>(message), flight_.airborne);
      };
    } else if (channel.topic == kSensorsTopic) {
      takers[id] = [&](const McapMessage& message) {
        flight_.end = Time(static_cast<std::int64_t>(message.log_time));
      };
    }
  }
  for (const McapMessage& message : file_->messages()) {
    if (const auto taker = takers.find(message.channel); taker != takers.end()) taker->second(message);
  }
  for (Interval& interval : flight_.airborne) interval.end = std::min(interval.end, flight_.end);
  simulated_ = !truth.attitudes.empty();
  for (RecordedEstimate* estimate : {&truth, &then}) {
    if (!estimate->attitudes.empty()) flight_.estimates.push_back(std::move(*estimate));
  }
  if (file_->truncated()) {
    flight_.remarks.push_back("the log was cut short at " + with_unit(to_seconds(flight_.end), "s") +
                              ": what came after is lost");
  }
}

std::string RunLog::place_of(const McapMessage& message) const {
  return path_.string() + ": topic " + file_->channels().at(message.channel).topic + ", message " +
         std::to_string(message.sequence) + ": ";
}

}  // namespace ironbird::scenarios
