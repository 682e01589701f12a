#include "scenarios/record/log.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "scenarios/config/one_line.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/allowance.hpp"
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

/// What is read as one topic: the messages of all channels that have its name and the schema of the first.
struct Source {
  std::uint16_t schema = 0;
  bool readable = false;
  std::vector<const McapMessage*> messages;
};

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
  explicit Contents(const std::filesystem::path& file);
  const std::vector<Ros2MessageType>& types_of(std::uint16_t schema);
  LogTopic decode(const std::string& name, const Source& source);

  std::filesystem::path path;
  McapReader reader;
  Allowance allowance;  ///< for the columns of all topics
  std::map<std::string, Source, std::less<>> sources;
  std::map<std::uint16_t, std::vector<Ros2MessageType>> types;
  std::map<std::string, LogTopic, std::less<>> decoded;
};

Log::Contents::Contents(const std::filesystem::path& file)
    : path(file), reader(file), allowance(reader.file_size()) {
  std::map<std::uint16_t, Source*> source_of;
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = reader.schemas().find(channel.schema);
    const bool readable =
        schema != reader.schemas().end() && schema->second.encoding == "ros2msg" && channel.encoding == "cdr";
    Source& source = sources.try_emplace(channel.topic, Source{channel.schema, readable, {}}).first->second;
    if (source.schema == channel.schema) source_of[id] = &source;
  }
  for (const McapMessage& message : reader.messages()) {
    const auto source = source_of.find(message.channel);
    if (source != source_of.end()) source->second->messages.push_back(&message);
  }
}

const std::vector<Ros2MessageType>& Log::Contents::types_of(std::uint16_t schema) {
  const auto known = types.find(schema);
  if (known != types.end()) return known->second;
  const McapSchema& text = reader.schemas().at(schema);
  Allowance rest = allowance;
  std::vector<Ros2MessageType> parsed = parse_ros2_schema(text.name, text.text, rest);
  allowance = rest;
  return types.emplace(schema, std::move(parsed)).first->second;
}

LogTopic Log::Contents::decode(const std::string& name, const Source& source) {
  LogTopic topic;
  topic.name_ = name;
  try {
    static const std::vector<Ros2MessageType> kNothing(1);
    const std::vector<Ros2MessageType>& message_types = source.readable ? types_of(source.schema) : kNothing;
    Allowance rest = allowance;
    TopicColumns columns(message_types, rest);
    for (const McapMessage* const message : source.messages) {
      topic.time_.push_back(static_cast<double>(message->log_time) / 1e9);
      if (source.readable) columns.add(message->data);
    }
    columns.finish(topic.fields_, topic.columns_, topic.texts_);
    allowance = rest;
  } catch (const std::runtime_error& error) {
    throw UserError(on_one_line(path.string() + ": topic " + name + ", message " +
                                std::to_string(topic.time_.size()) + ": " + error.what()));
  }
  return topic;
}

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
  const auto source = contents_->sources.find(name);
  if (source == contents_->sources.end()) return nullptr;
  return &contents_->decoded.emplace(name, contents_->decode(source->first, source->second)).first->second;
}

std::vector<std::string> Log::topics() const {
  std::vector<std::string> names;
  for (const auto& [name, source] : contents_->sources) names.push_back(name);
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

Log read_flown(const std::filesystem::path& file) {
  Log log = Log::read(file);
  if (log.end()) return log;
  throw UserError(file.string() +
                  ": nothing can be shown of it: it holds no message; name the log of a run that flew");
}

std::string what_is_lost(const Log& log, std::optional<double> flown) {
  if (!log.truncated()) return "";
  const double end = log.end().value_or(0.0);
  std::array<char, 120> text{};
  if (flown && *flown > end) {
    std::snprintf(text.data(), text.size(),
                  "the log was cut short at %.4g s of %.4g s: the last %.4g s are lost", end, *flown,
                  *flown - end);
  } else {
    std::snprintf(text.data(), text.size(), "the log was cut short at %.4g s: what came after is lost", end);
  }
  return text.data();
}

}  // namespace ironbird::scenarios
