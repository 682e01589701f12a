#include "scenarios/record/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <span>
#include <stdexcept>

#include "scenarios/record/crc32.hpp"
#include "scenarios/record/mcap_records.hpp"

namespace ironbird::scenarios {
namespace {

constexpr std::string_view kCompression = "zstd";
constexpr int kCompressionLevel = 1;
/// Content of a chunk in front of its compression's name, and behind it.
constexpr std::size_t kChunkHeadFixed = 8 + 8 + 8 + 4 + 4 + 8;

/// Room made beforehand, so that a flight of the usual length takes no memory; untouched room costs none.
constexpr std::size_t kExpectedChunks = 4096;
constexpr std::size_t kExpectedTopics = 16;

/// What ROS tools expect to find with a channel: reliable, keeps the last ten, nothing else special.
const McapMetadata kChannelMetadata{
    {"offered_qos_profiles",
     "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n  deadline:\n    sec: 9223372036\n"
     "    nsec: 854775807\n  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  liveliness: 1\n"
     "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
     "  avoid_ros_namespace_conventions: false\n"}};

}  // namespace

struct McapWriter::Compressor {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ~Compressor() { ZSTD_freeCCtx(context); }
};

McapWriter::McapWriter(const std::filesystem::path& path, const McapOptions& options)
    : file_(path, options.in_background), options_(options) {
  if (options.chunk_size < 1024) {
    throw std::invalid_argument("chunk_size = " + std::to_string(options.chunk_size) + ", must be >= 1024");
  }
  if (!options.journal) {
    head_size_ = kMcapRecordHead + kChunkHeadFixed + (options.compress ? kCompression.size() : 0);
    if (options.compress) compressor_ = std::make_unique<Compressor>();
  }
  ByteBuffer start;
  put_magic(start);
  put_header(start, "ros2", "ironbird");
  write_out(start.bytes());
  records_.reserve_more(2 * std::size_t{options.chunk_size} + head_size_);
  chunks_.reserve(kExpectedChunks);
  index_offsets_.reserve(kExpectedChunks * kExpectedTopics);
  records_.set_size(head_size_);
}

McapWriter::~McapWriter() {
  try {
    close();
  } catch (const std::exception&) {
    // The destructor of a log that nobody closed has nobody to tell.
  }
}

std::uint16_t McapWriter::add_schema(const Ros2Schema& schema) {
  for (const Schema& known : schemas_) {
    if (known.content.name == schema.name && known.content.text == schema.text) return known.id;
  }
  make_room_for_record();
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back({id, schema});
  put_schema(records_, id, schema.name, "ros2msg", schema.text);
  return id;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, const Ros2Schema& schema) {
  const std::uint16_t schema_id = add_schema(schema);
  make_room_for_record();
  const auto id = static_cast<std::uint16_t>(channels_.size());
  channels_.push_back({schema_id, std::string(topic), 0, {}});
  put_channel(records_, id, schema_id, topic, "cdr", kChannelMetadata);
  return id;
}

void McapWriter::make_room_for_record() {
  if (closed_) throw std::logic_error(file_.path().string() + ": the log is closed");
  if (file_.failed()) records_.set_size(head_size_);
  if (!options_.journal && records_size() >= options_.chunk_size) flush_chunk(records_.size());
}

ByteBuffer& McapWriter::begin_message(std::uint16_t channel, std::chrono::nanoseconds stamp) {
  message_begin_ = records_.size();
  message_channel_ = channel;
  message_time_ = static_cast<std::uint64_t>(stamp.count());
  records_.put(static_cast<std::uint8_t>(McapOpcode::kMessage));
  records_.put(std::uint64_t{0});
  records_.put(channel);
  records_.put(static_cast<std::uint32_t>(channels_[channel].count));
  records_.put(message_time_);
  records_.put(message_time_);
  return records_;
}

void McapWriter::end_message() {
  if (file_.failed() || closed_) {
    records_.set_size(head_size_);
    return;
  }
  const std::size_t length = records_.size() - message_begin_ - kMcapRecordHead;
  records_.put_at(message_begin_ + 1, static_cast<std::uint64_t>(length));
  if (options_.journal) {
    note_message(0);
    const bool due =
        message_time_ - flushed_time_ >= static_cast<std::uint64_t>(options_.flush_interval.count());
    if (due || records_.size() >= options_.chunk_size) flush_journal();
    return;
  }
  if (records_size() > options_.chunk_size && message_begin_ > head_size_) {
    const std::size_t end = records_.size();
    const std::size_t begin = message_begin_;
    flush_chunk(begin);
    std::memmove(records_.data() + head_size_, records_.data() + begin, end - begin);
    records_.set_size(head_size_ + end - begin);
    message_begin_ = head_size_;
  }
  note_message(message_begin_ - head_size_);
}

void McapWriter::note_message(std::uint64_t offset) {
  Channel& channel = channels_[message_channel_];
  ++channel.count;
  first_time_ = message_count_ == 0 ? message_time_ : std::min(first_time_, message_time_);
  last_time_ = std::max(last_time_, message_time_);
  ++message_count_;
  if (options_.journal) return;
  channel.index.emplace_back(message_time_, offset);
  chunk_first_time_ = chunk_messages_ == 0 ? message_time_ : std::min(chunk_first_time_, message_time_);
  chunk_last_time_ = chunk_messages_ == 0 ? message_time_ : std::max(chunk_last_time_, message_time_);
  ++chunk_messages_;
}

void McapWriter::write_out(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second) {
  const std::uint32_t crc = crc32(second, crc32(first, data_crc_));
  if (file_.write(first, second)) data_crc_ = crc;
}

std::uint32_t McapWriter::put_chunk_head(ByteBuffer& out, std::size_t uncompressed, std::size_t stored) {
  const std::span<const std::uint8_t> records(records_.data() + head_size_, uncompressed);
  const std::uint32_t crc = crc32(records);
  const std::size_t end = out.size();
  out.set_size(0);
  out.put(static_cast<std::uint8_t>(McapOpcode::kChunk));
  out.put(static_cast<std::uint64_t>(head_size_ - kMcapRecordHead + stored));
  out.put(chunk_first_time_);
  out.put(chunk_last_time_);
  out.put(static_cast<std::uint64_t>(uncompressed));
  out.put(crc);
  out.put_text(options_.compress ? kCompression : std::string_view());
  out.put(static_cast<std::uint64_t>(stored));
  out.set_size(end);
  return crc;
}

void McapWriter::compress_records(std::size_t end) {
  const std::size_t size = end - head_size_;
  compressed_.clear();
  compressed_.reserve_more(head_size_ + ZSTD_compressBound(size));
  const std::size_t stored =
      ZSTD_compressCCtx(compressor_->context, compressed_.data() + head_size_, ZSTD_compressBound(size),
                        records_.data() + head_size_, size, kCompressionLevel);
  if (ZSTD_isError(stored) != 0) {
    throw std::runtime_error(file_.path().string() + ": compressing failed: " + ZSTD_getErrorName(stored));
  }
  compressed_.set_size(head_size_ + stored);
}

std::size_t McapWriter::write_message_indexes(ChunkEntry& entry) {
  indexes_.clear();
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    Channel& channel = channels_[id];
    if (channel.index.empty()) continue;
    const auto number = static_cast<std::uint16_t>(id);
    index_offsets_.emplace_back(number, entry.offset + entry.length + indexes_.size());
    put_message_index(indexes_, number, channel.index);
    channel.index.clear();
  }
  entry.index_count = index_offsets_.size() - entry.first_index;
  return indexes_.size();
}

void McapWriter::flush_chunk(std::size_t end) {
  const std::size_t size = end - head_size_;
  if (size == 0 || file_.failed()) return;
  if (options_.compress) compress_records(end);
  ByteBuffer& chunk = options_.compress ? compressed_ : records_;
  const std::size_t chunk_end = options_.compress ? compressed_.size() : end;
  const std::size_t stored = chunk_end - head_size_;
  const std::uint32_t records_crc = put_chunk_head(chunk, size, stored);

  ChunkEntry entry{.start_time = chunk_first_time_,
                   .end_time = chunk_last_time_,
                   .offset = file_.size(),
                   .length = chunk_end,
                   .first_index = index_offsets_.size(),
                   .index_count = 0,
                   .index_length = 0,
                   .compressed_size = stored,
                   .uncompressed_size = size,
                   .compressed = options_.compress};
  entry.index_length = write_message_indexes(entry);
  chunk_first_time_ = chunk_last_time_ = chunk_messages_ = 0;
  records_.set_size(head_size_);

  data_crc_ = crc32({chunk.data(), head_size_}, data_crc_);
  // The checksum of records that are stored as they are is known already.
  data_crc_ = options_.compress ? crc32({chunk.data() + head_size_, stored}, data_crc_)
                                : crc32_of_both(data_crc_, records_crc, stored);
  data_crc_ = crc32(indexes_.bytes(), data_crc_);
  file_.write({chunk.data(), chunk_end}, indexes_.bytes());
  chunks_.push_back(entry);
}

void McapWriter::flush_journal() {
  flushed_time_ = message_time_;
  const std::size_t size = records_.size();
  records_.clear();
  write_out({records_.data(), size});
}

void McapWriter::flush() {
  if (closed_) return;
  if (options_.journal) {
    flush_journal();
  } else {
    flush_chunk(records_.size());
  }
}

void McapWriter::metadata(std::string_view name, const McapMetadata& values) {
  if (closed_) throw std::logic_error(file_.path().string() + ": the log is closed");
  if (file_.failed()) return;
  if (options_.journal) flush_journal();
  ByteBuffer record;
  put_metadata(record, name, values);
  metadata_.push_back({file_.size(), record.size(), std::string(name)});
  write_out(record.bytes());
}

void McapWriter::close() {
  if (closed_) return;
  if (!file_.failed()) flush();
  closed_ = true;
  if (!file_.failed()) write_summary();
  file_.close();
}

namespace {

/// The last record and what follows it. @param begin  of the summary in `out`, which the checksum is about
void put_footer(ByteBuffer& out, std::uint64_t summary_begin, std::uint64_t offsets_begin,
                std::size_t begin) {
  out.put(static_cast<std::uint8_t>(McapOpcode::kFooter));
  out.put(std::uint64_t{8 + 8 + 4});
  out.put(summary_begin);
  out.put(offsets_begin);
  out.put(crc32(out.bytes().subspan(begin)));
  put_magic(out);
}

}  // namespace

void McapWriter::write_summary() {
  ByteBuffer out;
  put_data_end(out, data_crc_);
  const std::uint64_t base = file_.size();
  const std::uint64_t summary_begin = base + out.size();
  const std::size_t begin = out.size();
  ByteBuffer offsets;
  std::size_t group_begin = begin;
  const auto end_group = [&](McapOpcode group) {
    if (out.size() > group_begin)
      put_summary_offset(offsets, group, base + group_begin, out.size() - group_begin);
    group_begin = out.size();
  };

  for (const Schema& schema : schemas_) {
    put_schema(out, schema.id, schema.content.name, "ros2msg", schema.content.text);
  }
  end_group(McapOpcode::kSchema);
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    const Channel& channel = channels_[id];
    put_channel(out, static_cast<std::uint16_t>(id), channel.schema, channel.topic, "cdr", kChannelMetadata);
  }
  end_group(McapOpcode::kChannel);
  put_statistics(out);
  end_group(McapOpcode::kStatistics);
  for (const ChunkEntry& chunk : chunks_) put_chunk_index(out, chunk);
  end_group(McapOpcode::kChunkIndex);
  for (const MetadataEntry& entry : metadata_) {
    put_metadata_index(out, entry.offset, entry.length, entry.name);
  }
  end_group(McapOpcode::kMetadataIndex);

  const std::uint64_t offsets_begin = base + out.size();
  out.append(offsets.bytes());
  put_footer(out, summary_begin, offsets_begin, begin);
  file_.write(out.bytes());
}

void McapWriter::put_statistics(ByteBuffer& out) const {
  const McapRecord record(out, McapOpcode::kStatistics);
  out.put(message_count_);
  out.put(static_cast<std::uint16_t>(schemas_.size()));
  out.put(static_cast<std::uint32_t>(channels_.size()));
  out.put(std::uint32_t{0});  // attachments
  out.put(static_cast<std::uint32_t>(metadata_.size()));
  out.put(static_cast<std::uint32_t>(chunks_.size()));
  out.put(first_time_);
  out.put(last_time_);
  out.put(static_cast<std::uint32_t>(channels_.size() * (2 + 8)));
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    out.put(static_cast<std::uint16_t>(id));
    out.put(channels_[id].count);
  }
}

void McapWriter::put_chunk_index(ByteBuffer& out, const ChunkEntry& chunk) const {
  const McapRecord record(out, McapOpcode::kChunkIndex);
  out.put(chunk.start_time);
  out.put(chunk.end_time);
  out.put(chunk.offset);
  out.put(chunk.length);
  out.put(static_cast<std::uint32_t>(chunk.index_count * (2 + 8)));
  for (std::size_t i = 0; i < chunk.index_count; ++i) {
    const auto& [channel, offset] = index_offsets_[chunk.first_index + i];
    out.put(channel);
    out.put(offset);
  }
  out.put(chunk.index_length);
  out.put_text(chunk.compressed ? kCompression : std::string_view());
  out.put(chunk.compressed_size);
  out.put(chunk.uncompressed_size);
}

}  // namespace ironbird::scenarios
