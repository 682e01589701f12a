#include "hil_bridge/serial_fcu/serial_fcu.hpp"

#include <array>
#include <span>

namespace ironbird::hil_bridge {

namespace {

constexpr Time kTryAgain = std::chrono::milliseconds(20);
constexpr std::size_t kInboxRoom = 4096;  // messages: a second of a unit that sends as fast as its line goes
constexpr std::size_t kOutgoingRoom =
    8192;  // bytes: 90 ms of a line of 921600 Bd, less than commands stay valid

bool writes_to_flash(const rosflight::Message& message) {
  const auto* order = std::get_if<rosflight::RosflightCmd>(&message);
  return order != nullptr && order->command == rosflight::kWriteParameters;
}

rosflight::Message with_printable_texts(rosflight::Message message) {
  if (auto* version = std::get_if<rosflight::RosflightVersion>(&message)) {
    rosflight::make_printable(version->version);
  } else if (auto* text = std::get_if<rosflight::Statustext>(&message)) {
    rosflight::make_printable(text->text);
  } else if (auto* value = std::get_if<rosflight::ParamValue>(&message)) {
    rosflight::make_printable(value->param_id);
  }
  return message;
}

/// Do these carry the unit's own SYS_ID? Its first texts and its answers to unknown orders carry another
/// number; a unit on which nobody has set anything still sends these.
bool tells_system(const rosflight::Message& message) {
  return std::holds_alternative<rosflight::Heartbeat>(message) ||
         std::holds_alternative<rosflight::SmallImu>(message);
}

}  // namespace

SerialFcu::SerialFcu(transport::ByteStream& line, const ConnectionConfig& config, Gate* gate)
    : line_(line), gate_(gate), connection_(config) {
  inbox_.reserve(kInboxRoom);
  outgoing_.reserve(kOutgoingRoom);
}

void SerialFcu::advance(Time now) {
  now_ = now;
  watch_line(now);
  std::array<std::uint8_t, transport::kReadRoom> bytes;
  while (const std::size_t count = line_.read(bytes)) {
    decoder_.push(std::span(bytes).first(count), [&](const rosflight::Frame& frame) { take(frame, now); });
  }
  statistics_.advance(now, decoder_.counts());
  if (!line_.is_up()) return;
  connection_.advance(now, [this](const rosflight::Message& message) { send(message); });
  flush();
}

void SerialFcu::watch_line(Time now) {
  if (!line_.is_up()) {
    was_up_ = false;
    if (tried_ != Time::min() && now - tried_ < kTryAgain) return;
    tried_ = now;
    if (!line_.reopen()) return;
  }
  if (was_up_) return;
  was_up_ = true;
  decoder_.clear();
  outgoing_.clear();
  statistics_.restart();
  connection_.begin(now);
}

void SerialFcu::take(const rosflight::Frame& frame, Time now) {
  statistics_.take(frame, now);
  const rosflight::Message message = with_printable_texts(frame.message);
  if (tells_system(message)) connection_.follow(frame.sender.system);
  connection_.take(message, now, statistics_.lost());
  if (inbox_.size() == kInboxRoom) {
    ++unfetched_;
    return;
  }
  inbox_.push_back({now, in_bench_time(message, now)});
}

rosflight::Message SerialFcu::in_bench_time(const rosflight::Message& message, Time now) {
  const auto translated = [&](std::uint64_t us) {
    const Time stamp = connection_.to_bench(rosflight::clock_of(us), now);
    return static_cast<std::uint64_t>(stamp.count() < 0 ? 0 : stamp.count() / 1000);
  };
  rosflight::Message result = message;
  if (auto* imu = std::get_if<rosflight::SmallImu>(&result)) {
    imu->time_boot_us = translated(imu->time_boot_us);
  } else if (auto* fix = std::get_if<rosflight::RosflightGnss>(&result)) {
    fix->rosflight_timestamp = translated(fix->rosflight_timestamp);
  }
  return result;
}

void SerialFcu::receive(std::vector<Arrival>& out) {
  out.insert(out.end(), inbox_.begin(), inbox_.end());
  inbox_.clear();
}

void SerialFcu::send(const rosflight::Message& message) {
  Gate& gate = gate_ == nullptr ? static_cast<Gate&>(questions_) : *gate_;
  if (const std::optional<rosflight::Message> passed = gate.pass(message, now_)) write(*passed);
}

void SerialFcu::write(const rosflight::Message& message) {
  if (!line_.is_up()) return;
  const std::uint8_t component = writes_to_flash(message) ? kFlashComponent : kComponent;
  const rosflight::FrameBytes frame = rosflight::encode_frame(message, sequence_, {kSystem, component});
  if (!flush() && outgoing_.size() + frame.size > kOutgoingRoom) {
    statistics_.count_unsent();
    return;
  }
  ++sequence_;
  outgoing_.insert(outgoing_.end(), frame.bytes.begin(),
                   frame.bytes.begin() + static_cast<std::ptrdiff_t>(frame.size));
  flush();
}

bool SerialFcu::flush() {
  if (outgoing_.empty()) return true;
  const std::size_t count = line_.write(outgoing_);
  outgoing_.erase(outgoing_.begin(), outgoing_.begin() + static_cast<std::ptrdiff_t>(count));
  return outgoing_.empty();
}

}  // namespace ironbird::hil_bridge
