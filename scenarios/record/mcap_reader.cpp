#include "scenarios/record/mcap_reader.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "scenarios/config/one_line.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/byte_cursor.hpp"
#include "scenarios/record/crc32.hpp"
#include "scenarios/record/log_bytes.hpp"

namespace ironbird::scenarios {
namespace {

/// A chunk that claims more than this is damaged, not large.
constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 30;

/// What zstd can make of so many bytes at most: the smallest block has four, and stands for 128 KiB.
std::uint64_t most_unpacked(std::uint64_t stored) {
  return (stored / 4 + 1) * ZSTD_BLOCKSIZE_MAX;
}

McapSchema read_schema(ByteCursor& cursor) {
  McapSchema schema;
  schema.name = cursor.text();
  schema.encoding = cursor.text();
  schema.text = cursor.text();
  return schema;
}

McapChannel read_channel(ByteCursor& cursor) {
  McapChannel channel;
  channel.id = cursor.get<std::uint16_t>();
  channel.schema = cursor.get<std::uint16_t>();
  channel.topic = cursor.text();
  channel.encoding = cursor.text();
  return channel;
}

McapMessage read_message(ByteCursor& cursor) {
  McapMessage message;
  message.channel = cursor.get<std::uint16_t>();
  message.sequence = cursor.get<std::uint32_t>();
  message.log_time = cursor.get<std::uint64_t>();
  message.publish_time = cursor.get<std::uint64_t>();
  message.data = cursor.rest();
  return message;
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& file) : path_(file), bytes_(read_log_bytes(file)) {
  const std::size_t magic = std::min(bytes_.size(), kMcapMagic.size());
  if (!std::equal(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(magic), kMcapMagic.begin())) {
    throw UserError(file.string() + ": is not a log: it does not begin like an MCAP file");
  }
  allowance_ = Allowance(bytes_.size());
  record_ = bytes_.data();
  scan(std::span<const std::uint8_t>(bytes_).subspan(magic), false);
}

void McapReader::fail(const std::string& what) const {
  throw UserError(
      on_one_line(path_.string() + ": byte " + std::to_string(record_ - bytes_.data()) + ": " + what));
}

void McapReader::pay(std::uint64_t bytes) {
  if (!allowance_.take(bytes)) fail("what it holds comes to " + allowance_.refusal());
}

void McapReader::scan(std::span<const std::uint8_t> records, bool inside_chunk) {
  while (records.size() >= kMcapRecordHead) {
    if (!inside_chunk) record_ = records.data();
    ByteCursor cursor(records);
    const auto opcode = static_cast<McapOpcode>(cursor.get<std::uint8_t>());
    const auto length = cursor.get<std::uint64_t>();
    if (length > cursor.rest().size()) break;
    const auto content = cursor.take(length);
    records = cursor.rest();
    try {
      if (!take(opcode, content, inside_chunk)) {
        truncated_ = !std::equal(records.begin(), records.end(), kMcapMagic.begin(), kMcapMagic.end());
        return;
      }
    } catch (const std::out_of_range&) {
      fail("a record is shorter than its kind needs");
    }
  }
  if (inside_chunk && !records.empty()) fail("a chunk ends inside a record");
}

bool McapReader::take(McapOpcode opcode, std::span<const std::uint8_t> content, bool inside_chunk) {
  ByteCursor cursor(content);
  switch (opcode) {
    case McapOpcode::kHeader:
      profile_ = cursor.text();
      writer_name_ = cursor.text();
      break;
    case McapOpcode::kSchema: {
      const auto id = cursor.get<std::uint16_t>();
      pay(sizeof(McapSchema));
      schemas_[id] = read_schema(cursor);
      break;
    }
    case McapOpcode::kChannel: {
      pay(sizeof(McapChannel));
      McapChannel channel = read_channel(cursor);
      add_map(cursor, channel.metadata);
      channels_[channel.id] = std::move(channel);
      break;
    }
    case McapOpcode::kMessage:
      pay(sizeof(McapMessage));
      messages_.push_back(read_message(cursor));
      if (!channels_.contains(messages_.back().channel)) fail("a message comes before its channel");
      break;
    case McapOpcode::kChunk:
      if (inside_chunk) fail("a chunk lies inside a chunk");
      take_chunk(content);
      break;
    case McapOpcode::kMetadata:
      pay(sizeof(McapMetadata));
      add_map(cursor, metadata_[std::string(cursor.text())]);
      break;
    case McapOpcode::kFooter:
      return false;
    default:  // indexes, statistics, attachments, and kinds of record that came later
      break;
  }
  return true;
}

void McapReader::add_map(ByteCursor& cursor, McapMetadata& values) {
  ByteCursor pairs(cursor.take(cursor.get<std::uint32_t>()));
  while (!pairs.rest().empty()) {
    pay(sizeof(McapMetadata::value_type));
    const std::string_view name = pairs.text();
    values[std::string(name)] = pairs.text();
  }
}

void McapReader::take_chunk(std::span<const std::uint8_t> content) {
  ByteCursor cursor(content);
  cursor.take(8 + 8);  // times of the first and last message
  const auto size = cursor.get<std::uint64_t>();
  const auto crc = cursor.get<std::uint32_t>();
  const std::string_view compression = cursor.text();
  auto records = cursor.take(cursor.get<std::uint64_t>());
  if (compression == "zstd") {
    records = decompressed(records, size);
  } else if (!compression.empty()) {
    fail("a chunk is compressed with '" + std::string(compression) + "', readable are zstd and none");
  }
  if (records.size() != size) fail("a chunk has another size than it says");
  if (crc != 0 && crc != crc32(records)) fail("a chunk is damaged: its checksum is wrong");
  scan(records, true);
}

std::span<const std::uint8_t> McapReader::decompressed(std::span<const std::uint8_t> stored,
                                                       std::uint64_t size) {
  if (size > std::min(kLargestChunk, most_unpacked(stored.size()))) {
    fail("a chunk claims " + std::to_string(size) + " bytes, compressed to " + std::to_string(stored.size()));
  }
  pay(size);
  // Not zeroed: a chunk that claims too much costs no more than what is in it.
  std::uint8_t* const out =
      unpacked_.emplace_back(std::make_unique_for_overwrite<std::uint8_t[]>(size)).get();
  const std::size_t result = ZSTD_decompress(out, size, stored.data(), stored.size());
  if (ZSTD_isError(result) != 0) fail(std::string("a chunk is damaged: ") + ZSTD_getErrorName(result));
  return {out, result};
}

}  // namespace ironbird::scenarios
