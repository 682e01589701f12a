#include "hil_bridge/virtual_fcu/telemetry.hpp"

#include <algorithm>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr std::uint64_t kHeartbeatPeriodUs = 1000000;
constexpr std::uint64_t kStatusPeriodUs = 100000;

/// True when `clock` is in another period than `last`, which it replaces.
bool entered(std::uint64_t period, std::uint64_t clock, std::uint64_t& last) {
  const std::uint64_t current = clock / period;
  const bool changed = current != last;
  last = current;
  return changed;
}

}  // namespace

void Telemetry::write(Severity severity, std::string_view text) {
  rosflight::Statustext message{.severity = static_cast<std::uint8_t>(severity), .text = {}};
  std::copy_n(text.begin(), std::min(text.size(), message.text.size() - 1), message.text.begin());
  if (connected_) {
    send(message);
    return;
  }
  const int slot = (oldest_held_ + held_count_) % kHeldTexts;
  held_[static_cast<std::size_t>(slot)] = {severity, message.text};
  if (held_count_ < kHeldTexts) {
    ++held_count_;
  } else {
    oldest_held_ = (oldest_held_ + 1) % kHeldTexts;
  }
}

void Telemetry::release_text() {
  if (!connected_ || held_count_ == 0) return;
  const HeldText& held = held_[static_cast<std::size_t>(oldest_held_)];
  const rosflight::Statustext message{.severity = static_cast<std::uint8_t>(held.severity),
                                      .text = held.text};
  // On the wire texts held back carry the low byte of the clock where the system number belongs.
  if (sent_ != nullptr) sent_->push_back({arrival_, message, static_cast<std::uint8_t>(clock_us_)});
  oldest_held_ = (oldest_held_ + 1) % kHeldTexts;
  --held_count_;
}

void Telemetry::send_parameter(const ParameterStore& parameters, ParameterId id) {
  if (!listened()) return;
  const ParameterInfo& info = kParameterTable[id.index];
  send(rosflight::ParamValue{.param_value = {parameters.bits(id)},
                             .param_count = kParameterCount,
                             .param_index = id.index,
                             .param_id = info.name,
                             .param_type = static_cast<std::uint8_t>(info.type)});
}

void Telemetry::continue_parameter_list(const ParameterStore& parameters) {
  if (next_parameter_ >= kParameterCount) return;
  send_parameter(parameters, {static_cast<std::uint16_t>(next_parameter_)});
  ++next_parameter_;
}

bool Telemetry::heartbeat_due() {
  return entered(kHeartbeatPeriodUs, clock_us_, second_);
}

bool Telemetry::status_due() {
  return entered(kStatusPeriodUs, clock_us_, tenth_);
}

bool Telemetry::output_due() {
  if (++samples_ < kOutputDivider) return false;
  samples_ = 0;
  return true;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
