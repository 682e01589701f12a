#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/record/byte_buffer.hpp"
#include "scenarios/record/mcap_format.hpp"
#include "scenarios/record/output_file.hpp"
#include "scenarios/record/ros2_schema.hpp"

namespace ironbird::scenarios {

/// How a log is laid out.
struct McapOptions {
  /// False: in chunks, with indexes; the fastest. True: message by message, so that whatever ends the writer
  /// costs at most `flush_interval` of messages.
  bool journal = false;
  bool compress = false;
  bool in_background = false;
  std::uint32_t chunk_size = 64 * 1024;
  std::chrono::nanoseconds flush_interval = std::chrono::milliseconds(100);

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("journal", self.journal, "1", "write message by message instead of in chunks");
    visit("compress", self.compress, "1", "compress each chunk with zstd, level 1");
    visit("in_background", self.in_background, "1",
          "a thread of its own writes to the disk: whoever records never waits for it");
    visit("chunk_size", self.chunk_size, "1", "most bytes of messages in a chunk", 1024.0, 16777216.0);
    visit("flush_interval", self.flush_interval, "ns", "most time a journal keeps messages in memory", 0.0,
          1e10);
  }
};

/// Writes one MCAP file: profile ros2, schemas ros2msg, messages cdr, with every index and checksum.
///
/// The bytes depend on nothing but the calls: no wall clock goes into the file. Messages cost no system call;
/// a chunk costs one. A write that fails (full disk) throws once, when its chunk is written; what was written
/// before stays readable and later calls do nothing. A single message larger than a chunk gets a chunk of its
/// own. Does not know what a message means.
class McapWriter {
 public:
  /// @throws std::runtime_error when the file cannot be made, std::invalid_argument for options out of bounds
  explicit McapWriter(const std::filesystem::path& path, const McapOptions& options = {});
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;
  /// Closes the log; errors are lost here, so call close() first.
  ~McapWriter();

  /// Adds a topic. @return its number
  std::uint16_t add_channel(std::string_view topic, const Ros2Schema& schema);

  /// The buffer to append one encoded message to; end_message() must follow.
  /// @param stamp  time of the message, >= 0
  ByteBuffer& begin_message(std::uint16_t channel, std::chrono::nanoseconds stamp);
  void end_message();

  /// Adds a record of names and texts. It is written at once.
  void metadata(std::string_view name, const McapMetadata& values);

  /// Writes everything still in memory to the file. In chunks this ends the chunk.
  void flush();

  /// Writes the closing records. Further calls do nothing.
  void close();

  /// Messages given so far.
  std::uint64_t message_count() const { return message_count_; }
  /// Bytes that were left out because the disk was too slow; always 0 unless in the background.
  std::uint64_t lost() const { return file_.lost(); }
  /// Bytes in the file so far.
  std::uint64_t file_size() const { return file_.size(); }

 private:
  struct Schema {
    std::uint16_t id;
    Ros2Schema content;
  };
  struct Channel {
    std::uint16_t schema;
    std::string topic;
    std::uint64_t count;
    /// Time and place in the chunk of each message of the chunk being filled.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;
  };
  struct ChunkEntry {
    std::uint64_t start_time, end_time, offset, length;
    /// Where its indexes stand in index_offsets_.
    std::size_t first_index, index_count;
    std::uint64_t index_length, compressed_size, uncompressed_size;
    bool compressed;
  };
  struct MetadataEntry {
    std::uint64_t offset, length;
    std::string name;
  };

  std::size_t records_size() const { return records_.size() - head_size_; }
  std::uint16_t add_schema(const Ros2Schema& schema);
  void make_room_for_record();
  void note_message(std::uint64_t offset);
  void write_out(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second = {});
  void flush_chunk(std::size_t end);
  std::size_t write_message_indexes(ChunkEntry& entry);
  std::uint32_t put_chunk_head(ByteBuffer& out, std::size_t uncompressed, std::size_t stored);
  void compress_records(std::size_t end);
  void flush_journal();
  void write_summary();
  void put_statistics(ByteBuffer& out) const;
  void put_chunk_index(ByteBuffer& out, const ChunkEntry& chunk) const;

  OutputFile file_;
  McapOptions options_;
  /// Bytes kept free in front of a chunk's records for its head; 0 in a journal.
  std::size_t head_size_ = 0;
  ByteBuffer records_;
  ByteBuffer indexes_;
  ByteBuffer compressed_;
  struct Compressor;
  std::unique_ptr<Compressor> compressor_;

  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  std::vector<ChunkEntry> chunks_;
  /// Of every chunk's indexes: channel and place in the file.
  std::vector<std::pair<std::uint16_t, std::uint64_t>> index_offsets_;
  std::vector<MetadataEntry> metadata_;
  std::uint32_t data_crc_ = 0;

  std::size_t message_begin_ = 0;
  std::uint16_t message_channel_ = 0;
  std::uint64_t message_time_ = 0;
  std::uint64_t message_count_ = 0;
  std::uint64_t first_time_ = 0, last_time_ = 0;
  std::uint64_t chunk_first_time_ = 0, chunk_last_time_ = 0, chunk_messages_ = 0;
  std::uint64_t flushed_time_ = 0;
  bool closed_ = false;
};

}  // namespace ironbird::scenarios
