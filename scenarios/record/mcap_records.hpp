#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "scenarios/record/byte_buffer.hpp"
#include "scenarios/record/mcap_format.hpp"

namespace ironbird::scenarios {

// Each function appends one MCAP record. Offsets count from the start of the file, times are nanoseconds.

/// Appends a record's head and fills in its length when it goes out of scope.
class McapRecord {
 public:
  McapRecord(ByteBuffer& out, McapOpcode opcode) : out_(out) {
    out_.put(static_cast<std::uint8_t>(opcode));
    begin_ = out_.size();
    out_.put(std::uint64_t{0});
  }
  McapRecord(const McapRecord&) = delete;
  McapRecord& operator=(const McapRecord&) = delete;
  ~McapRecord() { out_.put_at(begin_, static_cast<std::uint64_t>(out_.size() - begin_ - 8)); }

 private:
  ByteBuffer& out_;
  std::size_t begin_ = 0;
};

void put_magic(ByteBuffer& out);
/// A map of texts behind its length in bytes.
void put_map(ByteBuffer& out, const McapMetadata& values);
void put_header(ByteBuffer& out, std::string_view profile, std::string_view writer_name);
void put_schema(ByteBuffer& out, std::uint16_t id, std::string_view name, std::string_view encoding,
                std::string_view text);
void put_channel(ByteBuffer& out, std::uint16_t id, std::uint16_t schema, std::string_view topic,
                 std::string_view encoding, const McapMetadata& metadata);
void put_metadata(ByteBuffer& out, std::string_view name, const McapMetadata& values);
void put_metadata_index(ByteBuffer& out, std::uint64_t offset, std::uint64_t length, std::string_view name);
void put_data_end(ByteBuffer& out, std::uint32_t crc);
void put_summary_offset(ByteBuffer& out, McapOpcode group, std::uint64_t begin, std::uint64_t length);
/// The places of one channel's messages in the chunk before it, as (time, offset in the records).
void put_message_index(ByteBuffer& out, std::uint16_t channel,
                       std::span<const std::pair<std::uint64_t, std::uint64_t>> entries);

}  // namespace ironbird::scenarios
