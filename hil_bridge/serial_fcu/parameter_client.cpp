#include "hil_bridge/serial_fcu/parameter_client.hpp"

#include <algorithm>

namespace ironbird::hil_bridge {

namespace {

using std::chrono::milliseconds;

constexpr Time kListAgain = milliseconds(400);  // without any answer to a request for all
constexpr Time kBurstOver =
    milliseconds(60);  // without a value: the burst has ended, what is missing was lost
constexpr Time kReadAgain = milliseconds(60);  // without an answer to a request for one
constexpr int kRequestsAtOnce = 8;  // every kBetweenRequests: half of a line of 921600 Bd, commands go on
constexpr Time kBetweenRequests = milliseconds(5);
constexpr Time kSetAnswer = milliseconds(100);  // the FCU answers in its next pass
constexpr int kSetTries = 40;  // each reads back and sets again: 2^-40 is lost to a line that halves
constexpr std::size_t kSetsAtOnce = 8;
constexpr Time kWriteAnswer = milliseconds(1000);
constexpr int kWriteTries = 10;
constexpr int kMostParameters = 4096;

}  // namespace

void ParameterClient::address(std::uint8_t system) {
  if (system == system_) return;
  system_ = system;
  list_asked_ = Time::min();  // it did not hear the request
}

void ParameterClient::start_download(Time now) {
  slots_.clear();
  progress_ = {};
  downloading_ = true;
  list_asked_ = Time::min();
  last_value_ = now;
  requested_ = Time::min();
}

void ParameterClient::take(const rosflight::ParamValue& message, Time now) {
  const bool known_type = message.param_type == kIntegerParameter || message.param_type == kRealParameter;
  if (message.param_index >= message.param_count || message.param_count > kMostParameters || !known_type)
    return;
  last_value_ = now;
  if (slots_.size() != message.param_count) {
    slots_.assign(message.param_count, {});
    progress_.known = 0;
    progress_.count = message.param_count;
  }
  std::optional<ParameterRecord>& record = slots_[message.param_index].record;
  const ParameterRecord heard{std::string(rosflight::text_of(message.param_id)), message.param_type,
                              message.param_value.bits};
  if (!record) {
    ++progress_.known;
  } else if (*record != heard) {
    unsaved_ = true;
  }
  record = heard;
  progress_.complete = progress_.known == progress_.count;
  if (progress_.complete) downloading_ = false;
  settle(message.param_index);
}

void ParameterClient::take(const rosflight::RosflightCmdAck& message) {
  if (message.command != rosflight::kWriteParameters || write_ != ParameterOutcome::kPending) return;
  write_ = message.success != 0 ? ParameterOutcome::kDone : ParameterOutcome::kRefused;
  if (write_ == ParameterOutcome::kDone) unsaved_ = false;
}

std::string ParameterClient::set(const ParameterRecord& wanted) {
  const auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& candidate) {
    return candidate.record && candidate.record->name == wanted.name;
  });
  if (slot == slots_.end()) return wanted.name + ": the unit has no such parameter";
  if (slot->record->type != wanted.type) {
    return wanted.name + ": is " +
           (slot->record->type == kIntegerParameter ? "a whole number" : "a real number") + " in the unit";
  }
  // The FCU does not answer a set to the value that it has.
  if (slot->record->bits == wanted.bits) return {};
  const auto index = static_cast<std::uint16_t>(slot - slots_.begin());
  std::erase_if(sets_, [&](const Set& set) { return set.index == index; });
  sets_.push_back({.wanted = wanted, .index = index});
  return {};
}

void ParameterClient::write_to_flash() {
  write_ = ParameterOutcome::kPending;
  write_tries_ = 0;
  write_next_ = Time::min();
}

void ParameterClient::advance(Time now, const Send& send) {
  if (downloading_) request_missing(now, send);
  advance_sets(now, send);
  if (write_ == ParameterOutcome::kPending && sets_.empty()) advance_write(now, send);
}

void ParameterClient::request_missing(Time now, const Send& send) {
  if (slots_.empty()) {
    if (list_asked_ != Time::min() && now - list_asked_ < kListAgain) return;
    list_asked_ = now;
    send(rosflight::ParamRequestList{.target_system = system_, .target_component = 0});
    return;
  }
  if (now - last_value_ < kBurstOver && progress_.requests == 0) return;
  if (requested_ != Time::min() && now - requested_ < kBetweenRequests) return;
  requested_ = now;
  int sent = 0;
  for (std::size_t k = 0; k < slots_.size() && sent < kRequestsAtOnce; ++k) {
    Slot& slot = slots_[k];
    if (slot.record || (slot.asked != Time::min() && now - slot.asked < kReadAgain)) continue;
    slot.asked = now;
    ++sent;
    ++progress_.requests;
    send(rosflight::ParamRequestRead{.param_index = static_cast<std::int16_t>(k),
                                     .target_system = system_,
                                     .target_component = 0,
                                     .param_id = {}});
  }
}

void ParameterClient::advance_sets(Time now, const Send& send) {
  for (std::size_t k = 0; k < std::min(sets_.size(), kSetsAtOnce); ++k) {
    Set& set = sets_[k];
    if (set.next != Time::min() && now < set.next) continue;
    set.next = now + kSetAnswer;
    if (set.read_back) {
      send(rosflight::ParamRequestRead{.param_index = static_cast<std::int16_t>(set.index),
                                       .target_system = system_,
                                       .target_component = 0,
                                       .param_id = {}});
      set.read_back = false;
      continue;
    }
    if (++set.tries > kSetTries) {
      failures_.push_back(
          {set.wanted, set.answered ? ParameterOutcome::kDifferent : ParameterOutcome::kNoAnswer});
      sets_.erase(sets_.begin() + static_cast<std::ptrdiff_t>(k));
      return;
    }
    send(rosflight::ParamSet{.param_value = {set.wanted.bits},
                             .target_system = system_,
                             .target_component = 0,
                             .param_id = rosflight::field_of<16>(set.wanted.name),
                             .param_type = set.wanted.type});
    set.read_back = true;
  }
}

void ParameterClient::settle(std::uint16_t index) {
  const auto set =
      std::find_if(sets_.begin(), sets_.end(), [&](const Set& one) { return one.index == index; });
  if (set == sets_.end()) return;
  set->answered = true;
  if (slots_[index].record->bits == set->wanted.bits) sets_.erase(set);
}

void ParameterClient::advance_write(Time now, const Send& send) {
  if (write_next_ != Time::min() && now < write_next_) return;
  write_next_ = now + kWriteAnswer;
  if (++write_tries_ > kWriteTries) {
    write_ = ParameterOutcome::kNoAnswer;
    return;
  }
  send(rosflight::RosflightCmd{.command = rosflight::kWriteParameters});
}

std::vector<ParameterRecord> ParameterClient::known() const {
  std::vector<ParameterRecord> records;
  for (const Slot& slot : slots_) {
    if (slot.record) records.push_back(*slot.record);
  }
  return records;
}

std::optional<ParameterRecord> ParameterClient::find(std::string_view name) const {
  for (const Slot& slot : slots_) {
    if (slot.record && slot.record->name == name) return slot.record;
  }
  return std::nullopt;
}

}  // namespace ironbird::hil_bridge
