#include "hil_bridge/can/esc_controller.hpp"

#include <algorithm>
#include <cmath>

#include "simulator/types/bounds.hpp"

namespace ironbird::hil_bridge::can {

namespace {

constexpr Time kArmingPeriod = std::chrono::milliseconds(500);
constexpr Time kAnswerTimeout = std::chrono::seconds(1);
constexpr std::uint8_t kCommandPriority = 7;
constexpr std::uint8_t kOtherPriority = 24;

constexpr std::array kControllerHears = {subscription<NodeStatus>(), subscription<EscStatus>(),
                                         subscription<GetNodeInfoResponse>(), subscription<Allocation>()};
constexpr std::array kControllerSays = {NodeStatus::kType.key, RawCommand::kType.key, ArmingStatus::kType.key,
                                        GetNodeInfoRequest::kType.key, Allocation::kType.key};

const EscControllerParams& checked(const EscControllerParams& params) {
  simulator::check_bounds(params, "esc_controller");
  return params;
}

}  // namespace

EscController::EscController(const EscControllerParams& params, transport::FrameBus& bus, Time start)
    : bus_(bus),
      port_(static_cast<std::uint8_t>(checked(params).node), kControllerHears, kControllerSays, params.fd),
      motors_(static_cast<std::size_t>(params.count)),
      start_(start),
      next_status_(start),
      next_arming_(start) {
  if (params.grant_numbers) numbers_.emplace();
}

void EscController::set_armed(bool armed) {
  // The word goes out with the next step, not when it would be due.
  if (armed != armed_) next_arming_ = Time::min();
  armed_ = armed;
}

bool EscController::command(std::span<const double> throttles, Time now) {
  const bool sound =
      throttles.size() == motors_.size() &&
      std::all_of(throttles.begin(), throttles.end(), [](double t) { return t >= 0.0 && t <= 1.0; });
  RawCommand command;
  for (std::size_t motor = 0; motor < motors_.size(); ++motor) {
    const double throttle = sound && armed_ ? throttles[motor] : 0.0;
    command.cmd.push(static_cast<std::int16_t>(std::lround(throttle * kGreatestRawCommand)));
  }
  port_.send(command, kCommandPriority, now, 0, kCommandLifetime);
  port_.flush(now, bus_);
  return sound;
}

void EscController::step(Time now) {
  while (const std::optional<ReceivedFrame> frame = bus_.receive()) {
    if (const std::optional<ReceivedTransfer> transfer = port_.push(*frame))
      take(*transfer, std::min(frame->stamp, now));
  }
  if (now >= next_status_) {
    NodeStatus status;
    status.uptime_sec = static_cast<std::uint32_t>((now - start_) / kStatusPeriod);
    port_.send(status, kOtherPriority, now);
    next_status_ = now + kStatusPeriod;
  }
  if (now >= next_arming_) {
    port_.send(ArmingStatus{armed_ ? ArmingStatus::kArmed : ArmingStatus::kDisarmed}, kOtherPriority, now, 0,
               kArmingPeriod);
    next_arming_ = now + kArmingPeriod;
  }
  ask_names(now);
  port_.flush(now, bus_);
}

void EscController::take(const ReceivedTransfer& transfer, Time stamp) {
  const std::uint8_t source = transfer.head.source;
  if (source == 0) {
    const std::optional<Allocation> wish = message_of<Allocation>(transfer);
    if (wish && numbers_) take_wish(*wish, stamp);
    return;
  }
  if (const auto status = message_of<NodeStatus>(transfer)) {
    take_status(source, *status, stamp);
  } else if (const auto report = message_of<EscStatus>(transfer)) {
    take_report(source, *report, stamp);
  } else if (const auto info = message_of<GetNodeInfoResponse>(transfer)) {
    nodes_[source].name = info->name;
    nodes_[source].named = true;
  }
}

void EscController::take_wish(const Allocation& wish, Time now) {
  const auto taken = [&](std::uint8_t other) { return other == port_.node() || nodes_[other].known; };
  if (const auto answer = numbers_->take(wish, now, taken)) port_.send(*answer, kAllocationPriority, now);
}

void EscController::take_status(std::uint8_t source, const NodeStatus& status, Time stamp) {
  NodeRecord& record = nodes_[source];
  if (record.known && status.uptime_sec < record.status.uptime_sec) {
    ++record.restarts;
    // Another program may have come up.
    record.named = false;
  }
  record.status = status;
  record.heard = stamp;
  record.known = true;
}

void EscController::take_report(std::uint8_t source, const EscStatus& status, Time stamp) {
  if (status.esc_index >= motors_.size()) return;
  EscRecord& record = motors_[status.esc_index];
  const bool other_alive =
      record.node != 0 && record.node != source && stamp - record.heard <= kReportTimeout;
  if (other_alive) {
    ++record.conflicts;
    record.contested = stamp;
  }
  record.status = status;
  record.node = source;
  record.heard = stamp;
}

void EscController::ask_names(Time now) {
  for (std::uint8_t other = 1; other <= kGreatestNode; ++other) {
    NodeRecord& record = nodes_[other];
    const bool waiting = record.asked != Time(0) && now - record.asked < kAnswerTimeout;
    if (!node_alive(other, now) || record.named || waiting) continue;
    if (port_.send(GetNodeInfoRequest{}, kOtherPriority, now, other)) record.asked = now;
  }
}

bool EscController::node_alive(std::uint8_t other, Time now) const {
  const NodeRecord& record = node(other);
  return record.known && now - record.heard <= kNodeTimeout;
}

bool EscController::motor_ready(std::size_t motor, Time now) const {
  const EscRecord& record = motors_[motor];
  const bool contested = record.conflicts > 0 && now - record.contested <= kReportTimeout;
  return record.node != 0 && !contested && now - record.heard <= kReportTimeout &&
         node_alive(record.node, now) && node(record.node).status.health <= kHealthWarning;
}

}  // namespace ironbird::hil_bridge::can
