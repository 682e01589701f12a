#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ironbird::scenarios {

/// One topic of a log as columns of numbers.
///
/// A field is addressed by its path in the message: `p_NB_N.x`, `rotor_speed[2]`, `sensors.mag.m_B.x`,
/// `waypoints[1].p_N.z`. An optional part that is absent from a message reads as NaN; so do elements beyond
/// the end of a sequence. Booleans and enumerations read as numbers, times as seconds.
class LogTopic {
 public:
  const std::string& name() const { return name_; }

  /// Time of each message, s since the start of the run.
  const std::vector<double>& time() const { return time_; }

  bool has(std::string_view field) const;

  /// @throws std::out_of_range naming the field and the topic when there is no such field
  const std::vector<double>& column(std::string_view field) const;

  /// Paths of all columns, in the order of the schema.
  const std::vector<std::string>& fields() const { return fields_; }

  /// The texts of a string field, one per message. @throws std::out_of_range when there is none
  const std::vector<std::string>& texts(std::string_view field) const;

 private:
  friend class Log;
  std::string name_;
  std::vector<double> time_;
  std::vector<std::string> fields_;
  std::map<std::string, std::vector<double>, std::less<>> columns_;
  std::map<std::string, std::vector<std::string>, std::less<>> texts_;
};

/// A log read back: every topic decoded from its own schema, so that logs of other versions open too.
class Log {
 public:
  /// Reads what is whole in the file. @throws std::runtime_error naming the file when it cannot be opened or
  /// is not a log
  static Log read(const std::filesystem::path& file);
  Log(Log&&) noexcept;
  Log& operator=(Log&&) noexcept;
  ~Log();

  /// The topic, decoded on first use, or null.
  const LogTopic* topic(std::string_view name) const;

  /// Names of all topics, sorted.
  std::vector<std::string> topics() const;

  /// Metadata records by name, for example metadata().at("run").at("seed").
  const std::map<std::string, std::map<std::string, std::string>>& metadata() const;

  /// True when the file ended without its closing records.
  bool truncated() const;

  /// When its last message was written, s since the start of the run; nothing when it holds none.
  std::optional<double> end() const;

 private:
  struct Contents;
  explicit Log(std::unique_ptr<Contents> contents);
  std::unique_ptr<Contents> contents_;
};

/// A log of which something is to be shown. @throws UserError naming the file when it cannot be read, or
/// holds no message
Log read_flown(const std::filesystem::path& file);

/// What a log that was cut short no longer tells; empty when it is whole.
/// @param flown  how long the run was, s; nothing when nobody knows
std::string what_is_lost(const Log& log, std::optional<double> flown = std::nullopt);

}  // namespace ironbird::scenarios
