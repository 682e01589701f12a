// Any bytes as a log: it is refused in one line that names the file, or it is read; and of a log that is cut
// anywhere the messages before the cut are read, the same as of the whole one.

#include <algorithm>

#include "ci/fuzzing/harness.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/log.hpp"
#include "scenarios/record/mcap_reader.hpp"

namespace ironbird::fuzzing {

namespace {

using scenarios::McapMessage;
using scenarios::McapReader;

bool same(const McapMessage& one, const McapMessage& other) {
  return one.channel == other.channel && one.sequence == other.sequence && one.log_time == other.log_time &&
         one.publish_time == other.publish_time &&
         std::equal(one.data.begin(), one.data.end(), other.data.begin(), other.data.end());
}

/// Every topic as columns, all of one length.
void expect_columns(const std::string& path) {
  const scenarios::Log log = scenarios::Log::read(path);
  for (const std::string& name : log.topics()) {
    const scenarios::LogTopic* const topic = log.topic(name);
    require(topic != nullptr, "a topic that is listed is there");
    for (const std::string& field : topic->fields()) {
      if (topic->has(field))
        require(topic->column(field).size() == topic->time().size(), "a column is as long as its topic");
    }
  }
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  static const MemoryFile file;
  if (input.size() < 2) return;
  const std::size_t cut = (input[0] | static_cast<std::size_t>(input[1]) << 8U) % (input.size() - 1);
  const auto whole = input.subspan(2);
  try {
    file.write(whole);
    const McapReader log(file.path());
    for (const McapMessage& message : log.messages()) {
      require(log.channels().contains(message.channel), "a message has a channel");
    }
    expect_columns(file.path());
    file.write(whole.first(std::min(cut, whole.size())));
    const McapReader part(file.path());
    require(part.messages().size() <= log.messages().size(), "a part holds no more than the whole");
    require(std::equal(part.messages().begin(), part.messages().end(), log.messages().begin(), same),
            "a part holds the beginning of the whole");
  } catch (const scenarios::UserError& error) {
    const std::string what = error.what();
    require(what.starts_with(file.path() + ": "), "a refusal names the file: " + what);
    require(what.find('\n') == std::string::npos, "a refusal is one line: " + what);
  }
}

}  // namespace ironbird::fuzzing
