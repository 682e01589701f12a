#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace ironbird::scenarios {

// Facts of the MCAP container, version 0: what writer and reader must agree on.

/// First and last eight bytes of every file.
inline constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', 0x30, 0x0D, 0x0A};

/// Kinds of record. A record is this byte, the length of its content as uint64, and the content.
enum class McapOpcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F
};

/// Opcode and length in front of each record's content.
inline constexpr std::size_t kMcapRecordHead = 1 + 8;

/// Names and texts that travel with a log, sorted by name.
using McapMetadata = std::map<std::string, std::string>;

}  // namespace ironbird::scenarios
