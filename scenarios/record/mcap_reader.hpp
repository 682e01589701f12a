#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenarios/record/allowance.hpp"
#include "scenarios/record/mcap_format.hpp"

namespace ironbird::scenarios {

class ByteCursor;

/// A message type as a log carries it.
struct McapSchema {
  std::string name;
  std::string encoding;
  std::string text;
};

/// One topic of a log.
struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic;
  std::string encoding;
  McapMetadata metadata;
};

/// One message; `data` points into the reader.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;      ///< ns
  std::uint64_t publish_time = 0;  ///< ns
  std::span<const std::uint8_t> data;
};

/// Reads an MCAP file of anybody's into memory, from front to back and without its indexes.
///
/// Takes what is whole: a file cut at any byte gives its complete records. A chunk is one record, so one that
/// is cut is lost. Chunks may be stored or compressed with zstd; lz4 is refused. Attachments are skipped.
/// A file whose chunks unpack to more than an Allowance is refused.
class McapReader {
 public:
  /// @throws std::runtime_error naming the file, and the byte for damage in its middle
  explicit McapReader(const std::filesystem::path& file);
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  const std::string& profile() const { return profile_; }
  /// The program that wrote the file; the header calls it its library.
  const std::string& writer_name() const { return writer_name_; }
  const std::map<std::uint16_t, McapSchema>& schemas() const { return schemas_; }
  const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  /// In the order of the file.
  const std::vector<McapMessage>& messages() const { return messages_; }
  /// Records by name; a later record of the same name adds to the earlier one.
  const std::map<std::string, McapMetadata>& metadata() const { return metadata_; }
  /// Bytes.
  std::uint64_t file_size() const { return bytes_.size(); }
  /// The file ends without its closing records.
  bool truncated() const { return truncated_; }

 private:
  void scan(std::span<const std::uint8_t> records, bool inside_chunk);
  bool take(McapOpcode opcode, std::span<const std::uint8_t> content, bool inside_chunk);
  void add_map(ByteCursor& cursor, McapMetadata& values);
  void pay(std::uint64_t bytes);
  void take_chunk(std::span<const std::uint8_t> content);
  std::span<const std::uint8_t> decompressed(std::span<const std::uint8_t> stored, std::uint64_t size);
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::unique_ptr<std::uint8_t[]>> unpacked_;
  Allowance allowance_{0};
  const std::uint8_t* record_ = nullptr;
  std::string profile_;
  std::string writer_name_;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::vector<McapMessage> messages_;
  std::map<std::string, McapMetadata> metadata_;
  bool truncated_ = true;
};

}  // namespace ironbird::scenarios
