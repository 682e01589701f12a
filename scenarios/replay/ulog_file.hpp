#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "scenarios/replay/ulog_format.hpp"

namespace ironbird::scenarios {

/// One value of a record, found once and then read in every record.
struct UlogPlace {
  std::size_t offset = 0;
  UlogType type = UlogType::kDouble;
  std::size_t count = 1;  ///< elements that follow each other
};

/// Everything that one publisher of a topic logged, in the order of the file.
class UlogSeries {
 public:
  const std::string& topic() const { return topic_; }
  /// Which publisher: PX4's multi_id.
  int instance() const { return instance_; }
  /// Null when the format of the topic is not to be had; there are no records then.
  const UlogLayout* layout() const { return layout_; }

  std::size_t size() const { return records_.size(); }
  std::span<const std::uint8_t> record(std::size_t k) const { return records_[k]; }

  /// Where a field lies: `timestamp`, `gyro_rad`, `gyro_rad[2]`, `esc[3].esc_rpm`. @return nothing when the
  /// topic has no such field
  std::optional<UlogPlace> find(std::string_view path) const;

  /// A number of record `k`, whatever its type.
  double number(std::size_t k, const UlogPlace& place, std::size_t element = 0) const;
  /// The same, exact: a real number is cut off.
  std::int64_t integer(std::size_t k, const UlogPlace& place, std::size_t element = 0) const;

 private:
  friend class UlogReader;

  std::string topic_;
  int instance_ = 0;
  const UlogLayout* layout_ = nullptr;
  std::vector<std::span<const std::uint8_t>> records_;
};

/// The value of a parameter.
using UlogNumber = std::variant<std::int32_t, float>;

/// A parameter that was changed while the log was written.
struct UlogChange {
  std::string name;
  UlogNumber value;
  std::size_t after = 0;  ///< bytes of the file that were written before
};

/// Something that the autopilot said.
struct UlogText {
  char level = '6';             ///< '0' emergency to '7' debug, as syslog
  std::uint64_t timestamp = 0;  ///< us since boot
  std::optional<std::uint16_t> tag;
  std::string text;
};

/// What a file does not tell, or tells wrongly.
struct UlogDamage {
  std::uint64_t cut_bytes = 0;
  std::uint64_t skipped_bytes = 0;
  int skipped_places = 0;
  std::uint64_t unknown_messages = 0;
  std::uint64_t faulty_messages = 0;
  std::uint64_t homeless_records = 0;
  std::uint64_t misfit_records = 0;
  std::uint64_t dropouts = 0;
  std::uint64_t dropout_milliseconds = 0;
  int newer_version = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("cut_bytes", self.cut_bytes, "B", "of a message that has no end: power was cut");
    visit("skipped_bytes", self.skipped_bytes, "B", "in the middle, where no message could be made out");
    visit("skipped_places", self.skipped_places, "1", "in how many places that was");
    visit("unknown_messages", self.unknown_messages, "1",
          "of types that this reader does not know: passed over");
    visit("faulty_messages", self.faulty_messages, "1", "of known types, that cannot be");
    visit("homeless_records", self.homeless_records, "1",
          "of topics that were never announced, or have no format");
    visit("misfit_records", self.misfit_records, "1", "whose length is not their format's");
    visit("dropouts", self.dropouts, "1", "times that the autopilot's logger lost something");
    visit("dropout_milliseconds", self.dropout_milliseconds, "ms", "how long those were, together");
    visit("newer_version", self.newer_version, "1", "of the format than this reader knows; 0: not newer");
  }
};

/// A ULog file, the log of a PX4 autopilot, read into memory.
///
/// Reads everything that is whole: a file that is cut anywhere gives what was before the cut, and after
/// damage in the middle reading goes on at the next message that can be made out. Memory stays within a
/// constant times the size of the file.
class UlogFile {
 public:
  /// @throws UserError naming the file when it cannot be opened, is no ULog, or needs what this reader lacks
  static UlogFile read(const std::filesystem::path& file);
  /// The same of bytes in memory. @param name  in messages
  static UlogFile from(std::vector<std::uint8_t> bytes, const std::string& name);

  /// us since boot, when the log began.
  std::uint64_t start() const { return start_; }
  int version() const { return version_; }
  /// Every topic and publisher that was announced, in the order of the announcements.
  const std::vector<UlogSeries>& series() const { return series_; }
  /// @return null when nobody logged it
  const UlogSeries* find(std::string_view topic, int instance = 0) const;

  /// Parameters as they were when the log began.
  const std::map<std::string, UlogNumber, std::less<>>& parameters() const { return parameters_; }
  const std::vector<UlogChange>& changes() const { return changes_; }
  /// Default values: of the firmware, and of the vehicle's configuration.
  const std::map<std::string, UlogNumber, std::less<>>& firmware_defaults() const {
    return firmware_defaults_;
  }
  const std::map<std::string, UlogNumber, std::less<>>& vehicle_defaults() const { return vehicle_defaults_; }
  /// @return nothing when the log does not tell it
  std::optional<double> parameter(std::string_view name) const;

  /// What the autopilot told of itself once: `sys_name`, `ver_hw`, `ver_sw_release`; numbers as text.
  const std::map<std::string, std::string, std::less<>>& information() const { return information_; }
  /// What it told in several pieces, by name; a piece that goes on stands behind the one before.
  const std::map<std::string, std::vector<std::string>, std::less<>>& lists() const { return lists_; }
  const std::vector<UlogText>& texts() const { return texts_; }

  const UlogDamage& damage() const { return damage_; }
  /// What is damaged, in words, one line each; empty when nothing is.
  std::vector<std::string> complaints() const;
  std::uint64_t file_size() const { return bytes_.size(); }

  UlogFile(UlogFile&&) = default;
  UlogFile& operator=(UlogFile&&) = default;

 private:
  friend class UlogReader;
  UlogFile() = default;

  std::vector<std::uint8_t> bytes_;
  UlogLayouts layouts_;
  std::uint64_t start_ = 0;
  int version_ = 0;
  std::vector<UlogSeries> series_;
  std::map<std::string, UlogNumber, std::less<>> parameters_;
  std::map<std::string, UlogNumber, std::less<>> firmware_defaults_;
  std::map<std::string, UlogNumber, std::less<>> vehicle_defaults_;
  std::vector<UlogChange> changes_;
  std::map<std::string, std::string, std::less<>> information_;
  std::map<std::string, std::vector<std::string>, std::less<>> lists_;
  std::vector<UlogText> texts_;
  UlogDamage damage_;
};

}  // namespace ironbird::scenarios
