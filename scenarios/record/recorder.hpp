#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/record/cdr.hpp"
#include "scenarios/record/mcap_writer.hpp"
#include "scenarios/record/ros2_schema.hpp"

namespace ironbird::scenarios {

/// Says which topics are recorded, and how often. Of several rules that match a topic the last one holds.
struct TopicRule {
  /// A topic, or the beginning of topics followed by `*`.
  std::string topic = "*";
  bool record = true;
  /// Longest of this and the period that the topic was added with is in force.
  std::chrono::nanoseconds period{0};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("topic", self.topic, "", "a topic, or the beginning of topics and *");
    visit("record", self.record, "1", "false: leave the topic out");
    visit("period", self.period, "ns", "least time between two messages; 0: as often as it is offered", 0.0,
          1e12);
  }
};

/// How and what to record.
struct RecorderOptions {
  McapOptions file;
  std::vector<TopicRule> topics;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("file", self.file, "", "layout of the file");
    visit("topics", self.topics, "", "what is left out or thinned");
  }
};

/// A number that has no described struct, such as a module's probe: its name (a legal ROS field), unit,
/// meaning.
struct NumberField {
  std::string name;
  std::string unit;
  std::string meaning;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "small letters, digits and underscores");
    visit("unit", self.unit, "", "of the number");
    visit("meaning", self.meaning, "", "what it is");
  }
};

/// Writes described structs that live elsewhere to a log, each with its own period.
///
/// Looks at the structs through const references when observe() is called and never otherwise. Allocates only
/// when topics are added. Does not own what it records: every struct must outlive the last observe().
class Recorder {
 public:
  using Time = std::chrono::nanoseconds;

  /// One topic of this recorder.
  struct Channel {
    int index = -1;  ///< -1: left out by a rule
  };

  /// @throws std::runtime_error when the file cannot be made
  explicit Recorder(const std::filesystem::path& file, const RecorderOptions& options = {});

  /// When a topic is looked at.
  enum class When : std::uint8_t {
    kWithFrames,  ///< when a frame has come
    kAlways,
    kWhenTold  ///< by write()
  };

  /// Adds a topic that shows `live` at each multiple of `period`; 0: at each observe().
  /// @throws std::invalid_argument when the topic was added before or its type cannot be named
  template <class T>
  Channel add(std::string_view topic, const T& live, Time period = Time{0}, When when = When::kWithFrames) {
    const Channel channel = add_source(topic, ros2_schema<T>(last_word(topic)), &live, &encode<T>, period);
    sources_.back().when = when;
    return channel;
  }

  /// Adds a topic of numbers that lie one behind the other, one for each field.
  /// @param values  stay where they are until the last observe(); as many as fields
  /// @throws std::invalid_argument when there is no field or the topic was added before
  Channel add_numbers(std::string_view topic, const std::vector<NumberField>& fields, const double* values,
                      Time period = Time{0});

  /// Writes every topic that is due at `now`. @param now  never less than before
  /// @param frame  a frame has come; otherwise only topics that are shown always are looked at
  /// @throws std::runtime_error once when the file can no longer be written
  void observe(Time now, bool frame = true);

  /// Writes one message of a topic that shows something, now.
  void write(Channel channel, Time now);

  /// Makes a topic for write_once() before there is a message of it.
  template <class T>
  void announce(std::string_view topic) {
    add_source(topic, ros2_schema<T>(last_word(topic)), nullptr, &encode<T>, Time{0});
  }

  /// Writes one message now. The topic is made on first use and takes one type only.
  template <class T>
  void write_once(std::string_view topic, const T& value, Time now) {
    if (find(topic) == nullptr) announce<T>(topic);
    write(*find(topic), &encode<T>, &value, now);
  }

  /// Adds a record of names and texts.
  void metadata(std::string_view name, const McapMetadata& values) { writer_.metadata(name, values); }

  /// Writes the closing records; a log that was not closed still opens.
  void close() { writer_.close(); }

  const McapWriter& file() const { return writer_; }

 private:
  using Encode = void (*)(const void* value, ByteBuffer& out);

  struct Source {
    std::string topic;
    const void* live;
    Encode encode;
    Time period;
    Time next;
    std::uint16_t channel;
    bool recorded;
    When when = When::kWithFrames;
  };

  template <class T>
  static void encode(const void* value, ByteBuffer& out) {
    encode_cdr(*static_cast<const T*>(value), out);
  }

  struct Numbers {
    const double* values;
    std::size_t count;
  };
  static void encode_numbers(const void* numbers, ByteBuffer& out);
  static std::string_view last_word(std::string_view topic);
  Channel add_source(std::string_view topic, const Ros2Schema& schema, const void* live, Encode encoder,
                     Time period);
  const Source* find(std::string_view topic) const;
  void write(const Source& source, Encode encoder, const void* value, Time now);

  McapWriter writer_;
  std::vector<TopicRule> rules_;
  std::vector<Source> sources_;
  /// What sources of add_numbers() point to; a deque never moves its elements.
  std::deque<Numbers> numbers_;
};

}  // namespace ironbird::scenarios
