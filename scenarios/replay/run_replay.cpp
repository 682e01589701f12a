#include "scenarios/replay/run_replay.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <string_view>
#include <utility>

#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/cdr.hpp"
#include "scenarios/record/topics.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

/// In the order in which a tick computes them: of two that differ in one tick the earlier is the cause.
constexpr std::array<std::string_view, 7> kOrder{kRequestTopic, kFlightTopic,     kEstimateTopic,
                                                 kRouteTopic,   kTrajectoryTopic, kSetpointTopic,
                                                 kCommandTopic};

Time time_of(const McapMessage& message) {
  return Time(static_cast<std::int64_t>(message.log_time));
}

std::string exact_time(Time time) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6f s", to_seconds(time));
  return text.data();
}

std::ptrdiff_t place_in_tick(std::string_view topic) {
  return std::find(kOrder.begin(), kOrder.end(), topic) - kOrder.begin();
}

}  // namespace

RunReplay::RunReplay(const RunLog& log, const LoadedScenario& loaded, const autopilot::Modules& modules,
                     ReplayOptions options)
    : log_(log),
      replay_(log.flight(), loaded, modules, std::move(options)),
      same_configuration_(loaded.digest == log.digest()) {
  for (const auto& [id, channel] : log.file().channels()) wire(id, channel);
}

void RunReplay::wire(std::uint16_t id, const McapChannel& channel) {
  const std::string& topic = channel.topic;
  const autopilot::Signals& signals = replay_.autopilot().signals();
  hil_bridge::Telemetry& fcu = replay_.telemetry();
  if (topic == kSensorsTopic) handlers_[id] = [this](const McapMessage& m) { take_frame(m); };
  if (topic == kRequestTopic) {
    watch(id, channel, request_);
    handlers_[id] = [this](const McapMessage& m) { take_request(m); };
  }
  if (topic == kFlightTopic) watch(id, channel, signals.flight);
  if (topic == kEstimateTopic) watch(id, channel, signals.estimate);
  if (topic == kRouteTopic) watch(id, channel, signals.route);
  if (topic == kTrajectoryTopic) watch(id, channel, signals.trajectory);
  if (topic == kSetpointTopic) watch(id, channel, signals.setpoint);
  if (topic == kCommandTopic) watch(id, channel, signals.command);
  if (topic == kStatusTopic) take_over(id, channel, fcu.status);
  if (topic == kOutputTopic) take_over(id, channel, fcu.output_raw);
  if (topic == kUnitAttitudeTopic) take_over(id, channel, fcu.attitude);
  if (topic == kBatteryTopic) take_over(id, channel, fcu.battery);
  if (topic == kRcTopic) take_over(id, channel, fcu.rc);
  if (topic == kEventTopic) pass_on<RunEvent>(id, channel);
  if (topic == kTruthTopic) pass_on<simulator::Truth>(id, channel);
}

/// What is no business of the autopilot goes from log to log.
template <class T>
void RunReplay::pass_on(std::uint16_t id, const McapChannel& channel) {
  FlightLog* const out = replay_.log();
  if (out == nullptr || !log_.holds<T>(channel)) return;
  handlers_[id] = [this, out, &channel](const McapMessage& message) {
    out->recorder().write_once(channel.topic, log_.decode<T>(message), time_of(message));
  };
}

template <class T>
void RunReplay::watch(std::uint16_t id, const McapChannel& channel, const T& live) {
  if (!log_.holds<T>(channel)) {
    not_compared_.push_back(channel.topic);
    return;
  }
  const McapSchema& schema = log_.file().schemas().at(channel.schema);
  Allowance allowance(schema.text.size());
  Watched& watched = watched_[id];
  watched.topic = channel.topic;
  watched.encode = [&live](ByteBuffer& out) { encode_cdr(live, out); };
  watched.types = parse_ros2_schema(schema.name, schema.text, allowance);
  handlers_[id] = [this, &watched](const McapMessage& message) { compare(watched, message); };
}

/// What the unit told then is shown again.
template <class T>
void RunReplay::take_over(std::uint16_t id, const McapChannel& channel, T& live) {
  if (!log_.holds<T>(channel)) return;
  handlers_[id] = [this, &live](const McapMessage& message) { live = log_.decode<T>(message); };
}

ReplayResult RunReplay::run() {
  for (const McapMessage& message : log_.file().messages()) {
    const auto handler = handlers_.find(message.channel);
    if (handler != handlers_.end()) handler->second(message);
    if (!more_) break;
  }
  ReplayResult result = replay_.finish();
  for (std::string& remark : remarks()) result.remarks.push_back(std::move(remark));
  if (same_configuration_) result.same = same_as_then();
  return result;
}

void RunReplay::take_frame(const McapMessage& message) {
  // Who copies a log may number its messages anew: fewer than before is no gap.
  if (message.sequence > next_frame_) {
    frames_missing_ += message.sequence - next_frame_;
    if (!whole_until_) whole_until_ = last_frame_;
  }
  next_frame_ = message.sequence + 1;
  last_frame_ = time_of(message);
  replay_.step(log_.decode<autopilot::SensorFrame>(message), time_of(message));
  more_ = replay_.goes_on(time_of(message));
}

void RunReplay::take_request(const McapMessage& message) {
  const auto then = log_.decode<LoggedRequest>(message);
  try {
    const autopilot::Request request = request_of(then);
    request_ = logged(request, replay_.request(request, time_of(message)));
  } catch (const UserError& error) {
    throw UserError(log_.place_of(message) + error.what());
  }
  compare(watched_.at(message.channel), message);
}

void RunReplay::compare(Watched& watched, const McapMessage& message) {
  now_.clear();
  watched.encode(now_);
  ++watched.compared;
  const auto is = now_.bytes();
  if (std::equal(is.begin(), is.end(), message.data.begin(), message.data.end())) return;
  if (watched.different++ > 0) return;
  watched.first = time_of(message);
  try {
    watched.how = difference_of(watched.types, message.data, is);
  } catch (const UserError& error) {
    throw UserError(log_.place_of(message) + error.what());
  }
}

const RunReplay::Watched* RunReplay::first_different() const {
  const Watched* first = nullptr;
  for (const auto& [id, watched] : watched_) {
    if (watched.different == 0) continue;
    const auto order = [](const Watched& of) { return std::pair(of.first, place_in_tick(of.topic)); };
    if (first == nullptr || order(watched) < order(*first)) first = &watched;
  }
  return first;
}

std::string RunReplay::difference_text(const Watched& first) const {
  const std::string where = "the first at " + exact_time(first.first) + ": " + first.topic + " ";
  if (first.how.field.empty()) return where + "has other bytes of which no field can be named";
  return where + first.how.field + " was " + first.how.was + ", is " + first.how.is;
}

CheckResult RunReplay::same_as_then() const {
  CheckResult check;
  check.name = "the autopilot computes what it computed then, to the last bit";
  check.kind = "same";
  check.margin = check.time = std::numeric_limits<double>::quiet_NaN();
  const auto commands = std::find_if(watched_.begin(), watched_.end(),
                                     [](const auto& entry) { return entry.second.topic == kCommandTopic; });
  const std::uint64_t compared = commands == watched_.end() ? 0 : commands->second.compared;
  const Watched* first = first_different();
  if (first != nullptr && whole_until_ && first->first > *whole_until_) {
    check.explanation = "until " + exact_time(*whole_until_) + " it does; then the log lacks " +
                        std::to_string(frames_missing_) + " frames that flew";
  } else if (first != nullptr) {
    const std::uint64_t different = compared == 0 ? 0 : commands->second.different;
    check.outcome = Outcome::kFail;
    check.time = to_seconds(first->first);
    check.explanation = std::to_string(different) + " of " + std::to_string(compared) +
                        " commands are others; of all differences " + difference_text(*first);
  } else if (compared == 0) {
    check.explanation = "the log holds no command to compare with";
  } else {
    check.outcome = Outcome::kPass;
    check.explanation = "all " + std::to_string(compared) + " commands are the same";
  }
  return check;
}

std::vector<std::string> RunReplay::remarks() const {
  std::vector<std::string> all;
  for (const std::string& topic : not_compared_)
    all.push_back(topic + " was written by another version of Ironbird and is not compared");
  if (frames_missing_ > 0)
    all.push_back("the log lacks " + std::to_string(frames_missing_) + " frames, the first of them after " +
                  exact_time(*whole_until_) + ": the disk was too slow, or the file is damaged");
  if (same_configuration_) return all;
  const Watched* first = first_different();
  all.push_back(
      "the configuration is not the flight's; of what it computes " +
      (first == nullptr ? "nothing is different" : "some is different, " + difference_text(*first)));
  return all;
}

}  // namespace ironbird::scenarios
