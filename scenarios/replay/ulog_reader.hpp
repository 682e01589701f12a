#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scenarios/replay/ulog_file.hpp"

namespace ironbird::scenarios {

/// Goes through the bytes of a ULog file and fills a UlogFile.
///
/// Format: PX4 user guide, "ULog file format", versions 0 and 1. Nothing that the bytes say is trusted: every
/// length is looked at before what it measures.
class UlogReader {
 public:
  /// @param name  of the file, in messages
  UlogReader(std::vector<std::uint8_t> bytes, std::string name);

  /// @throws UserError
  UlogFile read();

 private:
  using Bytes = std::span<const std::uint8_t>;

  /// A message: where it begins, its type and what is in it.
  struct Message {
    std::size_t begin = 0;
    char type = 0;
    Bytes content;
    std::size_t end() const { return begin + kHeader + content.size(); }
  };
  static constexpr std::size_t kHeader = 3;

  void read_header();
  void read_flags();
  /// Reads the messages from here to there.
  /// @param is_cut  it is normal that the last one has no end
  void read_section(std::size_t begin, std::size_t end, bool is_cut);
  /// The message there, when its size fits.
  std::optional<Message> message_at(std::size_t place, std::size_t end) const;
  /// Can this be a message? Not only is its type known, its content fits that.
  bool is_likely(const Message& message) const;
  /// Do a few messages that can be such follow each other there?
  bool reads_on(std::size_t place, std::size_t end) const;
  /// Where the messages go on after `place`, or the end.
  std::size_t next_sound(std::size_t place, std::size_t end) const;

  /// Is it likely, and if it is long, does something sound follow it?
  bool is_believed(const Message& message, std::size_t end) const;
  void count_odd(const Message& message, bool known);
  /// @return can it be what its type says?
  bool take(const Message& message);
  bool take_format(Bytes content);
  bool take_information(Bytes content);
  bool take_list(Bytes content);
  bool take_parameter(const Message& message);
  bool take_default(Bytes content);
  bool take_subscription(Bytes content);
  bool take_record(Bytes content);
  bool take_text(Bytes content, bool tagged);
  bool take_dropout(Bytes content);
  void find_late_formats();

  std::string name_;
  UlogFile file_;
  std::vector<std::pair<std::size_t, std::size_t>> appended_;  // sections: begin and end
  std::unordered_map<std::uint16_t, std::size_t> homes_;       // series of a message id
  std::map<std::pair<std::string, int>, std::size_t> known_;   // series of topic and instance
  bool flying_ = false;                                        // the definitions are over
};

}  // namespace ironbird::scenarios
