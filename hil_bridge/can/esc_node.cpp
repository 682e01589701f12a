#include "hil_bridge/can/esc_node.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/types/bounds.hpp"

namespace ironbird::hil_bridge::can {

namespace {

constexpr std::uint8_t kReportPriority = 16;
constexpr std::uint8_t kStatusPriority = 24;

constexpr std::array kNodeHears = {
    subscription<RawCommand>(),    subscription<ArmingStatus>(),         subscription<GetNodeInfoRequest>(),
    subscription<GetSetRequest>(), subscription<ExecuteOpcodeRequest>(), subscription<RestartNodeRequest>(),
    subscription<Allocation>()};
constexpr std::array kNodeSays = {NodeStatus::kType.key, EscStatus::kType.key, Allocation::kType.key};

const EscNodeParams& checked(const EscNodeParams& params) {
  simulator::check_bounds(params, "esc_node");
  return params;
}

EscParameters::Values defaults(const EscNodeParams& params) {
  return {params.esc_index, params.status_rate, std::llround(params.command_timeout * 1e3),
          params.require_arming ? 1 : 0};
}

/// The same for every run: whoever keeps a table of boards finds this one again.
UniqueId unique_id_of(const EscNodeParams& params) {
  UniqueId id{};
  for (std::size_t k = 0; k < std::min(params.name.size(), id.size() - 1); ++k) {
    id[k] = static_cast<std::uint8_t>(params.name[k]);
  }
  id.back() = static_cast<std::uint8_t>(params.esc_index);
  return id;
}

/// The time at which something periodic is due again. What was missed is not made up for.
Time next_after(Time due, Time period, Time now) {
  return due + ((now - due) / period + 1) * period;
}

}  // namespace

EscNode::EscNode(const EscNodeParams& params, Time start)
    : name_(checked(params).name),
      unique_id_(unique_id_of(params)),
      port_(static_cast<std::uint8_t>(params.node), kNodeHears, kNodeSays, params.fd),
      parameters_(defaults(params)),
      start_(start),
      next_status_(start),
      next_report_(start) {
  if (params.node == 0) asking_.emplace(unique_id_, 0, start);
}

void EscNode::take(const ReceivedFrame& frame, Time now) {
  const std::optional<ReceivedTransfer> transfer = port_.push(frame);
  if (!transfer) return;
  if (holds<Allocation>(*transfer)) take_allocation(*transfer, now);
  if (port_.node() == 0) return;
  // A stamp from the future would stay fresh for ever.
  const Time begun = std::min(transfer->begun, now);
  if (const auto command = message_of<RawCommand>(*transfer)) {
    const auto place = static_cast<std::size_t>(parameters_[EscParameter::kEscIndex]);
    if (place >= command->cmd.count) return;
    throttle_ = static_cast<double>(std::max<int>(command->cmd.items[place], 0)) / kGreatestRawCommand;
    commanded_at_ = begun;
    commanded_ = true;
  } else if (const auto arming = message_of<ArmingStatus>(*transfer)) {
    armed_ = arming->status == ArmingStatus::kArmed;
    armed_at_ = begun;
    arming_heard_ = true;
  } else {
    answer(*transfer, now);
  }
}

void EscNode::take_allocation(const ReceivedTransfer& transfer, Time now) {
  const std::optional<Allocation> message = message_of<Allocation>(transfer);
  if (!message || !asking_) return;
  asking_->take(*message, transfer.head.source == 0, now);
  if (port_.node() != 0 || !asking_->node()) return;
  port_.set_node(*asking_->node());
  next_status_ = now;
  next_report_ = now;
}

void EscNode::ask_for_number(Time now) {
  if (const std::optional<Allocation> wish = asking_->step(now)) port_.send(*wish, kAllocationPriority, now);
}

void EscNode::answer(const ReceivedTransfer& request, Time now) {
  if (message_of<GetNodeInfoRequest>(request)) {
    port_.respond(info(now), request, now);
  } else if (const auto get_set = message_of<GetSetRequest>(request)) {
    port_.respond(parameters_.get_set(*get_set), request, now);
  } else if (const auto opcode = message_of<ExecuteOpcodeRequest>(request)) {
    port_.respond(parameters_.execute(*opcode), request, now);
  } else if (const auto again = message_of<RestartNodeRequest>(request)) {
    const bool meant = again->magic_number == RestartNodeRequest::kMagicNumber;
    port_.respond(RestartNodeResponse{meant}, request, now);
    if (meant) restart(now);
  }
}

void EscNode::restart(Time now) {
  parameters_.restart();
  start_ = now;
  next_status_ = now;
  next_report_ = now;
  throttle_ = 0.0;
  commanded_ = false;
  arming_heard_ = false;
  armed_ = false;
  if (!asking_) return;
  port_.set_node(0);
  asking_.emplace(unique_id_, 0, now);
}

void EscNode::step(const EscReading& reading, Time now, transport::FrameBus& bus) {
  health_ = reading.health;
  if (port_.node() == 0) {
    ask_for_number(now);
    port_.flush(now, bus);
    return;
  }
  if (now >= next_status_) {
    port_.send(status(now), kStatusPriority, now);
    next_status_ = next_after(next_status_, kStatusPeriod, now);
  }
  if (now >= next_report_) {
    const Time period = kStatusPeriod / parameters_[EscParameter::kStatusRate];
    // An old report helps nobody when the next one is there.
    port_.send(report(reading, now), kReportPriority, now, 0, period);
    next_report_ = next_after(next_report_, period, now);
  }
  port_.flush(now, bus);
}

EscCommand EscNode::command(Time now) const {
  const bool required = parameters_[EscParameter::kRequireArming] != 0;
  const bool armed = arming_heard_ ? armed_ && (!required || now - armed_at_ <= kArmingTimeout) : !required;
  if (!commanded_) return {};
  if (now - commanded_at_ > std::chrono::milliseconds(parameters_[EscParameter::kCommandTimeout])) {
    return {0.0, EscCondition::kStale};
  }
  if (!armed) return {0.0, EscCondition::kDisarmed};
  return {throttle_, EscCondition::kRunning};
}

NodeStatus EscNode::status(Time now) const {
  NodeStatus status;
  status.uptime_sec = static_cast<std::uint32_t>((now - start_) / kStatusPeriod);
  status.health = health_;
  status.mode = kModeOperational;
  return status;
}

GetNodeInfoResponse EscNode::info(Time now) const {
  GetNodeInfoResponse response;
  response.status = status(now);
  response.name = BoundedText<80>(name_);
  response.hardware_version.unique_id = unique_id_;
  return response;
}

EscStatus EscNode::report(const EscReading& reading, Time now) const {
  constexpr double kRpm = 30.0 / std::numbers::pi;
  EscStatus status;
  status.error_count = reading.errors;
  status.voltage = static_cast<float>(reading.voltage);
  status.current = static_cast<float>(reading.current);
  status.temperature = static_cast<float>(reading.temperature);
  constexpr double kGreatestRpm = 131071.0;
  const double rpm = std::isfinite(reading.speed) ? reading.speed * kRpm : 0.0;
  status.rpm = static_cast<std::int32_t>(std::lround(std::clamp(rpm, -kGreatestRpm, kGreatestRpm)));
  status.power_rating_pct = static_cast<std::uint8_t>(std::lround(100.0 * command(now).throttle));
  status.esc_index = static_cast<std::uint8_t>(parameters_[EscParameter::kEscIndex]);
  return status;
}

}  // namespace ironbird::hil_bridge::can
