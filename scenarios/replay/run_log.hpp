#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "scenarios/record/cdr_decoder.hpp"
#include "scenarios/record/mcap_reader.hpp"
#include "scenarios/record/ros2_schema.hpp"
#include "scenarios/replay/recorded_flight.hpp"

namespace ironbird::scenarios {

/// The log of a run of Ironbird's own, simulated or on hardware: frames, requests and configuration are the
/// complete input of its autopilot.
class RunLog {
 public:
  /// @throws UserError naming the file and what it lacks when it is no such log
  static RunLog read(const std::filesystem::path& file);

  const McapReader& file() const { return *file_; }
  /// What was recorded beside the frames: truth where there is one, else the estimate of then. Has no
  /// messages.
  const RecordedFlight& flight() const { return flight_; }
  /// It tells of the truth, so there was a model.
  bool simulated() const { return simulated_; }
  /// As `LoadedScenario::effective_config` and its digest.
  const std::string& configuration() const { return configuration_; }
  const std::string& digest() const { return digest_; }

  /// The messages of this channel are what is written of a T today.
  template <class T>
  bool holds(const McapChannel& channel) const {
    const auto schema = file_->schemas().find(channel.schema);
    return schema != file_->schemas().end() && channel.encoding == "cdr" &&
           schema->second.text == ros2_schema<T>(last_word(channel.topic)).text;
  }

  /// The struct in a message. @throws UserError naming file, topic and message when it is none
  template <class T>
  T decode(const McapMessage& message) const {
    try {
      return decode_cdr<T>(message.data);
    } catch (const UserError& error) {
      throw UserError(place_of(message) + error.what());
    }
  }

  /// "FILE: topic TOPIC, message 12: "
  std::string place_of(const McapMessage& message) const;

 private:
  RunLog() = default;
  static std::string_view last_word(std::string_view topic) { return topic.substr(topic.rfind('/') + 1); }
  void describe_flight();
  void take_recorded();
  template <class T>
  void require(std::string_view topic) const;

  std::filesystem::path path_;
  std::unique_ptr<McapReader> file_;  // messages point into it
  RecordedFlight flight_;
  std::string configuration_;
  std::string digest_;
  bool simulated_ = false;
};

/// The file begins as logs of ours do.
bool is_mcap(const std::filesystem::path& file);

}  // namespace ironbird::scenarios
