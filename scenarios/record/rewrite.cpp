#include "scenarios/record/rewrite.hpp"

#include <map>

#include "scenarios/config/user_error.hpp"
#include "scenarios/record/mcap_reader.hpp"

namespace ironbird::scenarios {

void rewrite_log(const std::filesystem::path& from, const std::filesystem::path& to,
                 const McapOptions& options) {
  const McapReader reader(from);
  McapWriter writer(to, options);
  std::map<std::uint16_t, std::uint16_t> numbers;
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = reader.schemas().find(channel.schema);
    if (schema == reader.schemas().end() || schema->second.encoding != "ros2msg" ||
        channel.encoding != "cdr") {
      throw UserError(from.string() + ": topic " + channel.topic + " is no ROS 2 topic");
    }
    numbers[id] = writer.add_channel(channel.topic, {schema->second.name, schema->second.text});
  }
  for (const McapMessage& message : reader.messages()) {
    const auto stamp = std::chrono::nanoseconds(static_cast<std::int64_t>(message.log_time));
    writer.begin_message(numbers.at(message.channel), stamp).append(message.data);
    writer.end_message();
  }
  for (const auto& [name, values] : reader.metadata()) writer.metadata(name, values);
  writer.close();
}

}  // namespace ironbird::scenarios
