#include "scenarios/record/recorder.hpp"

#include <algorithm>
#include <stdexcept>

namespace ironbird::scenarios {
namespace {

bool matches(std::string_view pattern, std::string_view topic) {
  if (!pattern.ends_with('*')) return pattern == topic;
  return topic.starts_with(pattern.substr(0, pattern.size() - 1));
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& file, const RecorderOptions& options)
    : writer_(file, options.file), rules_(options.topics) {}

std::string_view Recorder::last_word(std::string_view topic) {
  return topic.substr(topic.rfind('/') + 1);
}

Recorder::Channel Recorder::add_source(std::string_view topic, const Ros2Schema& schema, const void* live,
                                       Encode encoder, Time period) {
  if (find(topic) != nullptr) {
    throw std::invalid_argument("topic " + std::string(topic) + " is recorded already");
  }
  Source source{std::string(topic), live, encoder, period, Time::min(), 0, true, When::kWithFrames};
  for (const TopicRule& rule : rules_) {
    if (!matches(rule.topic, topic)) continue;
    source.recorded = rule.record;
    source.period = std::max(period, rule.period);
  }
  if (source.recorded) source.channel = writer_.add_channel(topic, schema);
  sources_.push_back(std::move(source));
  return {sources_.back().recorded ? static_cast<int>(sources_.size()) - 1 : -1};
}

Recorder::Channel Recorder::add_numbers(std::string_view topic, const std::vector<NumberField>& fields,
                                        const double* values, Time period) {
  if (fields.empty()) throw std::invalid_argument("topic " + std::string(topic) + " has no fields");
  Ros2Schema schema{"ironbird_msgs/msg/" + camel_case(topic), ""};
  for (const NumberField& field : fields) {
    schema.text += "float64 " + field.name + "  # [" + field.unit + "] " + field.meaning + "\n";
  }
  numbers_.push_back({values, fields.size()});
  return add_source(topic, schema, &numbers_.back(), &encode_numbers, period);
}

void Recorder::encode_numbers(const void* numbers, ByteBuffer& out) {
  const auto* list = static_cast<const Numbers*>(numbers);
  CdrEncoder encoder(out);
  for (std::size_t i = 0; i < list->count; ++i) encoder.write(list->values[i]);
  encoder.finish();
}

const Recorder::Source* Recorder::find(std::string_view topic) const {
  const auto found = std::find_if(sources_.begin(), sources_.end(),
                                  [&](const Source& source) { return source.topic == topic; });
  return found == sources_.end() ? nullptr : &*found;
}

void Recorder::write(Channel channel, Time now) {
  if (channel.index < 0) return;
  const Source& source = sources_[static_cast<std::size_t>(channel.index)];
  source.encode(source.live, writer_.begin_message(source.channel, now));
  writer_.end_message();
}

void Recorder::write(const Source& source, Encode encoder, const void* value, Time now) {
  if (!source.recorded) return;
  if (source.encode != encoder) {
    throw std::invalid_argument("topic " + source.topic + " is recorded already with another type");
  }
  encoder(value, writer_.begin_message(source.channel, now));
  writer_.end_message();
}

void Recorder::observe(Time now, bool frame) {
  for (Source& source : sources_) {
    if (source.when == When::kWhenTold || (!frame && source.when == When::kWithFrames)) continue;
    if (source.live == nullptr || !source.recorded || now < source.next) continue;
    if (source.period > Time{0}) source.next = (now / source.period + 1) * source.period;
    source.encode(source.live, writer_.begin_message(source.channel, now));
    writer_.end_message();
  }
}

}  // namespace ironbird::scenarios
