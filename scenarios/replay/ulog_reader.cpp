#include "scenarios/replay/ulog_reader.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "scenarios/config/one_line.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/ulog_values.hpp"

namespace ironbird::scenarios {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 7> kMagic = {'U', 'L', 'o', 'g', 0x01, 0x12, 0x35};
constexpr std::size_t kFileHeader = 16;
constexpr std::array<std::uint8_t, 8> kSync = {0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12};
constexpr int kKnownVersion = 1;
constexpr std::uint8_t kAppendedData = 1;
constexpr std::size_t kFlagBytes = 40;  // of the flags that are known
constexpr int kLikelyInARow = 4;
constexpr int kLeastBeforeACut = 2;
constexpr std::size_t kUsualText = 1024;  // bytes: PX4 writes texts of 127
constexpr std::string_view kTypes = "BFIMPQARDLCSO";

/// Not the whole text is looked at: whoever seeks a message asks this at every byte.
bool begins_like_a_format(std::string_view text) {
  constexpr std::size_t kLongestName = 128;
  const std::string_view begin = text.substr(0, kLongestName);
  const std::size_t colon = begin.find(':');
  return colon != std::string_view::npos && colon > 0 &&
         std::all_of(begin.begin(), begin.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](char c) { return c > ' ' && c < 0x7F; });
}

}  // namespace

UlogReader::UlogReader(std::vector<std::uint8_t> bytes, std::string name) : name_(std::move(name)) {
  file_.bytes_ = std::move(bytes);
}

UlogFile UlogReader::read() {
  read_header();
  read_flags();
  const std::size_t end = appended_.empty() ? file_.bytes_.size() : appended_.front().first;
  read_section(kFileHeader, end, !appended_.empty());
  for (const auto& [from, to] : appended_) read_section(from, to, false);
  find_late_formats();
  return std::move(file_);
}

void UlogReader::read_header() {
  const Bytes bytes(file_.bytes_);
  if (bytes.empty()) throw UserError(name_ + ": is empty; was the log copied to its end?");
  const std::size_t seen = std::min(bytes.size(), kMagic.size());
  if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(seen), kMagic.begin())) {
    throw UserError(name_ + ": is not a ULog: it does not begin like one");
  }
  if (bytes.size() < kFileHeader) {
    throw UserError(name_ + ": is cut after " + std::to_string(bytes.size()) +
                    " bytes: a ULog's header alone has " + std::to_string(kFileHeader));
  }
  file_.version_ = bytes[kMagic.size()];
  if (file_.version_ > kKnownVersion) file_.damage_.newer_version = file_.version_;
  file_.start_ = ulog_value<std::uint64_t>(bytes, kMagic.size() + 1);
}

void UlogReader::read_flags() {
  const std::size_t size = file_.bytes_.size();
  const std::optional<Message> first = message_at(kFileHeader, size);
  if (!first || first->type != 'B' || first->content.size() < kFlagBytes) return;
  const Bytes incompatible = first->content.subspan(8, 8);
  for (std::size_t k = 0; k < incompatible.size(); ++k) {
    const std::uint8_t known = k == 0 ? kAppendedData : 0;
    if ((incompatible[k] & ~known) != 0) {
      throw UserError(
          name_ +
          ": is a ULog of a kind that came later: its flags say that readers which do not know it "
          "must not read it");
    }
  }
  if ((incompatible[0] & kAppendedData) == 0) return;
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto begin = ulog_value<std::uint64_t>(first->content, 16 + 8 * k);
    const bool goes_on = begin >= first->end() && (begins.empty() || begin > begins.back());
    if (begin == 0) continue;
    if (begin <= size && goes_on) {
      begins.push_back(static_cast<std::size_t>(begin));
    } else {
      ++file_.damage_.faulty_messages;
    }
  }
  for (std::size_t k = 0; k < begins.size(); ++k) {
    appended_.emplace_back(begins[k], k + 1 < begins.size() ? begins[k + 1] : size);
  }
}

void UlogReader::read_section(std::size_t begin, std::size_t end, bool is_cut) {
  std::size_t place = begin;
  while (place < end) {
    const std::optional<Message> message = message_at(place, end);
    const bool known = message && kTypes.find(message->type) != std::string_view::npos;
    if (known && is_believed(*message, end) && take(*message)) {
      place = message->end();
      continue;
    }
    // What is unknown or odd is passed over where that leads to something sound.
    if (message && !message->content.empty() && (message->end() == end || reads_on(message->end(), end))) {
      count_odd(*message, known);
      place = message->end();
      continue;
    }
    const std::size_t next = next_sound(place + 1, end);
    if (next == end) {
      if (!is_cut) file_.damage_.cut_bytes += end - place;
      return;
    }
    file_.damage_.skipped_bytes += next - place;
    ++file_.damage_.skipped_places;
    place = next;
  }
}

void UlogReader::count_odd(const Message& message, bool known) {
  UlogDamage& damage = file_.damage_;
  if (!known) {
    ++damage.unknown_messages;
  } else if (message.type != 'D' || message.content.size() < sizeof(std::uint16_t)) {
    ++damage.faulty_messages;
  } else if (homes_.contains(ulog_value<std::uint16_t>(message.content, 0))) {
    ++damage.misfit_records;
  } else {
    ++damage.homeless_records;
  }
}

std::optional<UlogReader::Message> UlogReader::message_at(std::size_t place, std::size_t end) const {
  const Bytes bytes(file_.bytes_);
  if (end - place < kHeader) return std::nullopt;
  const std::size_t size = ulog_value<std::uint16_t>(bytes, place);
  if (size > end - place - kHeader) return std::nullopt;
  return Message{place, static_cast<char>(bytes[place + 2]), bytes.subspan(place + kHeader, size)};
}

bool UlogReader::is_likely(const Message& message) const {
  const Bytes content = message.content;
  switch (message.type) {
    case 'S':
      return content.size() == kSync.size() && std::equal(kSync.begin(), kSync.end(), content.begin());
    case 'D': {
      if (content.size() < sizeof(std::uint16_t)) return false;
      const auto home = homes_.find(ulog_value<std::uint16_t>(content, 0));
      if (home == homes_.end()) return false;
      const UlogLayout* const layout = file_.series_[home->second].layout_;
      return layout == nullptr || layout->takes(content.size() - sizeof(std::uint16_t));
    }
    case 'B':
      return content.size() >= kFlagBytes;
    case 'O':
    case 'R':
      return content.size() == sizeof(std::uint16_t);
    case 'F':
      return begins_like_a_format(ulog_text(content));
    case 'I':
    case 'P':
      return ulog_keyed(content).has_value();
    case 'M':
    case 'Q':
      return !content.empty() && ulog_keyed(content.subspan(1)).has_value();
    case 'A':
      return content.size() > 3 && content[3] >= 0x20 && content[3] < 0x7F;
    case 'L':
      return content.size() >= 9 && content[0] >= '0' && content[0] <= '7';
    case 'C':
      return content.size() >= 11 && content[0] >= '0' && content[0] <= '7';
    default:
      return false;
  }
}

bool UlogReader::reads_on(std::size_t place, std::size_t end) const {
  for (int k = 0; k < kLikelyInARow && place < end; ++k) {
    const std::optional<Message> message = message_at(place, end);
    // The last one may be cut.
    if (!message) return k >= kLeastBeforeACut;
    if (!is_likely(*message)) return false;
    if (message->type == 'S') return true;  // nothing else has its eight bytes
    place = message->end();
  }
  return true;
}

std::size_t UlogReader::next_sound(std::size_t place, std::size_t end) const {
  while (place + kHeader <= end && !reads_on(place, end)) ++place;
  return place + kHeader <= end ? place : end;
}

bool UlogReader::is_believed(const Message& message, std::size_t end) const {
  if (!is_likely(message)) return false;
  // A false size makes any text swallow what stands behind it.
  const bool is_short = message.content.size() <= kUsualText || message.type == 'D' || message.type == 'F';
  return is_short || message.end() == end || reads_on(message.end(), end);
}

bool UlogReader::take(const Message& message) {
  const Bytes content = message.content;
  if (message.type == 'A' || message.type == 'L' || message.type == 'C') flying_ = true;
  switch (message.type) {
    case 'B':
    case 'R':
    case 'S':
      return true;  // read_flags has read the first
    case 'F':
      return take_format(content);
    case 'I':
      return take_information(content);
    case 'M':
      return take_list(content);
    case 'P':
      return take_parameter(message);
    case 'Q':
      return take_default(content);
    case 'A':
      return take_subscription(content);
    case 'D':
      return take_record(content);
    case 'L':
      return take_text(content, false);
    case 'C':
      return take_text(content, true);
    case 'O':
      return take_dropout(content);
    default:
      return false;
  }
}

bool UlogReader::take_format(Bytes content) {
  std::optional<UlogFormat> format = parse_ulog_format(ulog_text(content));
  if (!format) return false;
  file_.layouts_.add(std::move(*format));
  return true;
}

bool UlogReader::take_information(Bytes content) {
  const auto found = ulog_keyed(content);
  const auto text = found ? ulog_value_text(*found) : std::nullopt;
  if (!text) return false;
  file_.information_.insert_or_assign(found->key.name, *text);
  return true;
}

bool UlogReader::take_list(Bytes content) {
  const auto found = content.empty() ? std::nullopt : ulog_keyed(content.subspan(1));
  const auto text = found ? ulog_value_text(*found) : std::nullopt;
  if (!text) return false;
  std::vector<std::string>& pieces = file_.lists_[found->key.name];
  const bool goes_on = content[0] != 0 && !pieces.empty();
  if (goes_on) {
    pieces.back() += *text;
  } else {
    pieces.push_back(*text);
  }
  return true;
}

bool UlogReader::take_parameter(const Message& message) {
  const auto found = ulog_keyed(message.content);
  const auto value = found ? ulog_parameter(*found) : std::nullopt;
  if (!value) return false;
  const bool first = file_.parameters_.emplace(found->key.name, *value).second;
  if (!first || flying_) file_.changes_.push_back({found->key.name, *value, message.begin});
  return true;
}

bool UlogReader::take_default(Bytes content) {
  const auto found = content.empty() ? std::nullopt : ulog_keyed(content.subspan(1));
  const auto value = found ? ulog_parameter(*found) : std::nullopt;
  if (!value) return false;
  if ((content[0] & 1U) != 0) file_.firmware_defaults_.insert_or_assign(found->key.name, *value);
  if ((content[0] & 2U) != 0) file_.vehicle_defaults_.insert_or_assign(found->key.name, *value);
  return true;
}

bool UlogReader::take_subscription(Bytes content) {
  if (content.size() < 4) return false;
  const int instance = content[0];
  const auto id = ulog_value<std::uint16_t>(content, 1);
  std::string topic(ulog_text(content.subspan(3)));
  const auto [known, is_new] = known_.try_emplace({topic, instance}, file_.series_.size());
  if (is_new) {
    UlogSeries series;
    series.topic_ = std::move(topic);
    series.instance_ = instance;
    file_.series_.push_back(std::move(series));
  }
  homes_.insert_or_assign(id, known->second);
  return true;
}

bool UlogReader::take_record(Bytes content) {
  if (content.size() < sizeof(std::uint16_t)) return false;
  const auto home = homes_.find(ulog_value<std::uint16_t>(content, 0));
  if (home == homes_.end()) return false;
  UlogSeries& series = file_.series_[home->second];
  const Bytes record = content.subspan(sizeof(std::uint16_t));
  if (series.layout_ == nullptr) series.layout_ = file_.layouts_.find(series.topic_);
  if (series.layout_ != nullptr && !series.layout_->takes(record.size())) return false;
  series.records_.push_back(record);
  return true;
}

bool UlogReader::take_text(Bytes content, bool tagged) {
  const std::size_t head = tagged ? 11 : 9;
  if (content.size() < head) return false;
  UlogText said;
  said.level = static_cast<char>(content[0]);
  if (tagged) said.tag = ulog_value<std::uint16_t>(content, 1);
  said.timestamp = ulog_value<std::uint64_t>(content, head - sizeof(std::uint64_t));
  said.text = on_one_line(std::string(ulog_text(content.subspan(head))));
  file_.texts_.push_back(std::move(said));
  return true;
}

bool UlogReader::take_dropout(Bytes content) {
  ++file_.damage_.dropouts;
  file_.damage_.dropout_milliseconds += ulog_value<std::uint16_t>(content, 0);
  return true;
}

// Formats may come after the records that they describe.
void UlogReader::find_late_formats() {
  file_.layouts_.look_again();
  for (UlogSeries& series : file_.series_) {
    if (series.layout_ == nullptr) series.layout_ = file_.layouts_.find(series.topic_);
    if (series.layout_ == nullptr) {
      file_.damage_.homeless_records += series.records_.size();
      series.records_.clear();
      continue;
    }
    file_.damage_.misfit_records +=
        std::erase_if(series.records_, [&](Bytes record) { return !series.layout_->takes(record.size()); });
  }
}

}  // namespace ironbird::scenarios
