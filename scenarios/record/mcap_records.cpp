#include "scenarios/record/mcap_records.hpp"

namespace ironbird::scenarios {

void put_magic(ByteBuffer& out) {
  out.append(kMcapMagic);
}

void put_map(ByteBuffer& out, const McapMetadata& values) {
  const std::size_t begin = out.size();
  out.put(std::uint32_t{0});
  for (const auto& [name, value] : values) {
    out.put_text(name);
    out.put_text(value);
  }
  out.put_at(begin, static_cast<std::uint32_t>(out.size() - begin - 4));
}

void put_header(ByteBuffer& out, std::string_view profile, std::string_view writer_name) {
  const McapRecord record(out, McapOpcode::kHeader);
  out.put_text(profile);
  out.put_text(writer_name);
}

void put_schema(ByteBuffer& out, std::uint16_t id, std::string_view name, std::string_view encoding,
                std::string_view text) {
  const McapRecord record(out, McapOpcode::kSchema);
  out.put(id);
  out.put_text(name);
  out.put_text(encoding);
  out.put_text(text);
}

void put_channel(ByteBuffer& out, std::uint16_t id, std::uint16_t schema, std::string_view topic,
                 std::string_view encoding, const McapMetadata& metadata) {
  const McapRecord record(out, McapOpcode::kChannel);
  out.put(id);
  out.put(schema);
  out.put_text(topic);
  out.put_text(encoding);
  put_map(out, metadata);
}

void put_metadata(ByteBuffer& out, std::string_view name, const McapMetadata& values) {
  const McapRecord record(out, McapOpcode::kMetadata);
  out.put_text(name);
  put_map(out, values);
}

void put_metadata_index(ByteBuffer& out, std::uint64_t offset, std::uint64_t length, std::string_view name) {
  const McapRecord record(out, McapOpcode::kMetadataIndex);
  out.put(offset);
  out.put(length);
  out.put_text(name);
}

void put_data_end(ByteBuffer& out, std::uint32_t crc) {
  const McapRecord record(out, McapOpcode::kDataEnd);
  out.put(crc);
}

void put_summary_offset(ByteBuffer& out, McapOpcode group, std::uint64_t begin, std::uint64_t length) {
  const McapRecord record(out, McapOpcode::kSummaryOffset);
  out.put(static_cast<std::uint8_t>(group));
  out.put(begin);
  out.put(length);
}

void put_message_index(ByteBuffer& out, std::uint16_t channel,
                       std::span<const std::pair<std::uint64_t, std::uint64_t>> entries) {
  const McapRecord record(out, McapOpcode::kMessageIndex);
  out.put(channel);
  out.put(static_cast<std::uint32_t>(16 * entries.size()));
  for (const auto& [time, offset] : entries) {
    out.put(time);
    out.put(offset);
  }
}

}  // namespace ironbird::scenarios
