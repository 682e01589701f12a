#include "scenarios/record/log.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "scenarios/config/one_line.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/mcap_reader.hpp"
#include "scenarios/record/topic_columns.hpp"

namespace ironbird::scenarios {
namespace {

template <class Columns>
const auto& find_or_throw(const Columns& columns, std::string_view field, const std::string& topic,
                          const char* kind) {
  const auto found = columns.find(field);
  if (found == columns.end()) {
    throw std::out_of_range("topic " + topic + " has no " + kind + " '" + std::string(field) + "'");
  }
  return found->second;
}

}  // namespace

bool LogTopic::has(std::string_view field) const {
  return columns_.find(field) != columns_.end();
}

const std::vector<double>& LogTopic::column(std::string_view field) const {
  return find_or_throw(columns_, field, name_, "field");
}

const std::vector<std::string>& LogTopic::texts(std::string_view field) const {
  return find_or_throw(texts_, field, name_, "text field");
}

struct Log::Contents {
  explicit Contents(const std::filesystem::path& file) : path(file), reader(file) {}

  std::filesystem::path path;
  McapReader reader;
  std::map<std::string, LogTopic, std::less<>> decoded;
};

Log::Log(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
Log::Log(Log&&) noexcept = default;
Log& Log::operator=(Log&&) noexcept = default;
Log::~Log() = default;

Log Log::read(const std::filesystem::path& file) {
  return Log(std::make_unique<Contents>(file));
}

const LogTopic* Log::topic(std::string_view name) const {
  const auto known = contents_->decoded.find(name);
  if (known != contents_->decoded.end()) return &known->second;
  const McapReader& reader = contents_->reader;
  const auto& channels = reader.channels();
  const auto channel = std::find_if(channels.begin(), channels.end(),
                                    [&](const auto& entry) { return entry.second.topic == name; });
  if (channel == channels.end()) return nullptr;

  LogTopic topic;
  topic.name_ = name;
  const auto schema = reader.schemas().find(channel->second.schema);
  const bool readable = schema != reader.schemas().end() && schema->second.encoding == "ros2msg" &&
                        channel->second.encoding == "cdr";
  try {
    TopicColumns columns(readable ? parse_ros2_schema(schema->second.name, schema->second.text)
                                  : std::vector<Ros2MessageType>(1));
    for (const McapMessage& message : reader.messages()) {
      const McapChannel& from = channels.at(message.channel);
      if (from.topic != name || from.schema != channel->second.schema) continue;
      topic.time_.push_back(static_cast<double>(message.log_time) / 1e9);
      if (readable) columns.add(message.data);
    }
    if (readable) columns.finish(topic.fields_, topic.columns_, topic.texts_);
  } catch (const std::runtime_error& error) {
    throw UserError(on_one_line(contents_->path.string() + ": topic " + topic.name_ + ", message " +
                                std::to_string(topic.time_.size()) + ": " + error.what()));
  }
  return &contents_->decoded.emplace(topic.name_, std::move(topic)).first->second;
}

std::vector<std::string> Log::topics() const {
  std::vector<std::string> names;
  for (const auto& [id, channel] : contents_->reader.channels()) names.push_back(channel.topic);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

const std::map<std::string, std::map<std::string, std::string>>& Log::metadata() const {
  return contents_->reader.metadata();
}

bool Log::truncated() const {
  return contents_->reader.truncated();
}

std::optional<double> Log::end() const {
  std::optional<double> end;
  for (const McapMessage& message : contents_->reader.messages())
    end = std::max(end.value_or(0.0), static_cast<double>(message.log_time) / 1e9);
  return end;
}

std::string what_is_lost(const Log& log, std::optional<double> flown) {
  if (!log.truncated()) return "";
  const std::optional<double> end = log.end();
  if (!end) return "the log was cut short before its first message: nothing of the flight is in it";
  std::array<char, 120> text{};
  if (flown && *flown > *end) {
    std::snprintf(text.data(), text.size(),
                  "the log was cut short at %.4g s of %.4g s: the last %.4g s are lost", *end, *flown,
                  *flown - *end);
  } else {
    std::snprintf(text.data(), text.size(), "the log was cut short at %.4g s: what came after is lost", *end);
  }
  return text.data();
}

}  // namespace ironbird::scenarios
