#include "scenarios/record/mcap_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <stdexcept>

#include "scenarios/record/mcap_reader.hpp"
#include "scenarios/record/test/by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using namespace by_hand;  // NOLINT: this file compares bytes
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using ::testing::HasSubstr;

const Ros2Schema kSchema{"ironbird_msgs/msg/Number", "float64 value\n"};

class McapWriterTest : public ::testing::Test {
 protected:
  /// A file of its own for each test.
  std::filesystem::path path(const std::string& suffix = "") const {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::path(::testing::TempDir()) /
           (std::string("writer_") + test->name() + suffix + ".mcap");
  }
};

void put(McapWriter& writer, std::uint16_t channel_id, nanoseconds stamp, const std::string& data) {
  writer.begin_message(channel_id, stamp).append(data.data(), data.size());
  writer.end_message();
}

/// The quality-of-service text that the writer gives every channel.
std::string qos_map() {
  return text("offered_qos_profiles") +
         text(
             "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n"
             "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
             "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  liveliness: 1\n"
             "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
             "  avoid_ros_namespace_conventions: false\n");
}

std::string statistics(int messages, int channels, int metadata, int chunks, std::uint64_t first,
                       std::uint64_t last, const std::string& counts) {
  return record(0x0B, u64(static_cast<std::uint64_t>(messages)) + u16(1) +
                          u32(static_cast<std::uint64_t>(channels)) + u32(0) +
                          u32(static_cast<std::uint64_t>(metadata)) +
                          u32(static_cast<std::uint64_t>(chunks)) + u64(first) + u64(last) + text(counts));
}

/// Data, end of data, summary groups with their offsets, footer, magic.
std::string whole_file(const std::string& data, const std::vector<std::pair<int, std::string>>& groups) {
  const std::string front = magic() + header() + data;
  const std::string start = front + record(0x0F, u32(crc(front)));
  std::string summary;
  std::string offsets;
  for (const auto& [opcode, content] : groups) {
    const std::uint64_t begin = start.size() + summary.size();
    offsets += record(0x0E, u8(static_cast<std::uint64_t>(opcode)) + u64(begin) + u64(content.size()));
    summary += content;
  }
  const std::string before_crc =
      summary + offsets + u8(0x02) + u64(20) + u64(start.size()) + u64(start.size() + summary.size());
  return start + before_crc + u32(crc(before_crc)) + magic();
}

TEST_F(McapWriterTest, WritesAChunkedFileByteForByte) {
  McapWriter writer(path());
  const std::uint16_t a = writer.add_channel("/a", kSchema);
  const std::uint16_t b = writer.add_channel("/b", kSchema);
  put(writer, a, nanoseconds(10), "one");
  put(writer, b, nanoseconds(15), "two");
  put(writer, a, nanoseconds(20), "three");
  writer.close();

  const std::string schemas = schema(1, kSchema.name, kSchema.text);
  const std::string channels = channel(0, 1, "/a", qos_map()) + channel(1, 1, "/b", qos_map());
  const std::string one = message(0, 0, 10, "one");
  const std::string two = message(1, 0, 15, "two");
  const std::string records = schemas + channels + one + two + message(0, 1, 20, "three");
  const std::uint64_t at = (schemas + channels).size();
  const std::string the_chunk = chunk(10, 20, records, crc(records));
  const std::string index_a =
      record(0x07, u16(0) + text(u64(10) + u64(at) + u64(20) + u64(at + one.size() + two.size())));
  const std::string index_b = record(0x07, u16(1) + text(u64(15) + u64(at + one.size())));
  const std::uint64_t chunk_at = (magic() + header()).size();
  const std::uint64_t index_at = chunk_at + the_chunk.size();
  const std::string chunk_index = record(
      0x08, u64(10) + u64(20) + u64(chunk_at) + u64(the_chunk.size()) +
                text(u16(0) + u64(index_at) + u16(1) + u64(index_at + index_a.size())) +
                u64(index_a.size() + index_b.size()) + text("") + u64(records.size()) + u64(records.size()));
  EXPECT_EQ(read_file(path()),
            whole_file(the_chunk + index_a + index_b,
                       {{0x03, schemas},
                        {0x04, channels},
                        {0x0B, statistics(3, 2, 0, 1, 10, 20, u16(0) + u64(2) + u16(1) + u64(1))},
                        {0x08, chunk_index}}));
}

TEST_F(McapWriterTest, WritesAJournalByteForByte) {
  McapWriter writer(path(), {.journal = true});
  const std::uint16_t a = writer.add_channel("/a", kSchema);
  put(writer, a, nanoseconds(10), "one");
  writer.metadata("run", {{"b", "2"}, {"a", "1"}});
  put(writer, a, nanoseconds(20), "two");
  writer.close();

  const std::string schemas = schema(1, kSchema.name, kSchema.text);
  const std::string channels = channel(0, 1, "/a", qos_map());
  const std::string before = schemas + channels + message(0, 0, 10, "one");
  const std::string metadata =
      record(0x0C, text("run") + text(text("a") + text("1") + text("b") + text("2")));
  const std::uint64_t metadata_at = (magic() + header() + before).size();
  EXPECT_EQ(read_file(path()),
            whole_file(before + metadata + message(0, 1, 20, "two"),
                       {{0x03, schemas},
                        {0x04, channels},
                        {0x0B, statistics(2, 1, 1, 0, 10, 20, u16(0) + u64(2))},
                        {0x0D, record(0x0D, u64(metadata_at) + u64(metadata.size()) + text("run"))}}));
}

TEST_F(McapWriterTest, WritesAnEmptyLog) {
  McapWriter(path()).close();
  const McapReader reader(path());
  EXPECT_FALSE(reader.truncated());
  EXPECT_TRUE(reader.messages().empty());
}

TEST_F(McapWriterTest, SharesASchemaBetweenTopics) {
  McapWriter writer(path());
  writer.add_channel("/a", kSchema);
  writer.add_channel("/b", kSchema);
  writer.add_channel("/c", {"ironbird_msgs/msg/Other", "float64 value\n"});
  writer.close();
  EXPECT_EQ(McapReader(path()).schemas().size(), 2u);
}

struct LayoutCase {
  const char* name;
  McapOptions options;
};
class McapLayoutTest : public ::testing::TestWithParam<LayoutCase> {
 protected:
  std::filesystem::path path(const std::string& suffix = "") const {
    return std::filesystem::path(::testing::TempDir()) /
           ("layout_" + std::string(GetParam().name) + suffix + ".mcap");
  }
};

/// Messages of many sizes on three topics; one is larger than a small chunk.
void write_many(const std::filesystem::path& file, const McapOptions& options, int count = 500) {
  McapWriter writer(file, options);
  for (int i = 0; i < count; ++i) {
    const auto channel_id = static_cast<std::uint16_t>(i % 3);
    if (i < 3) writer.add_channel("/" + std::to_string(i), kSchema);
    const std::size_t size = i == 77 ? 5000 : static_cast<std::size_t>(i * 37 % 200);
    put(writer, channel_id, milliseconds(i), std::string(size, static_cast<char>(i)));
  }
  writer.close();
}

TEST_P(McapLayoutTest, GivesBackEveryMessageInOrder) {
  write_many(path(), GetParam().options);
  const McapReader reader(path());
  EXPECT_FALSE(reader.truncated());
  ASSERT_EQ(reader.messages().size(), 500u);
  for (std::size_t i = 0; i < 500; ++i) {
    const McapMessage& message = reader.messages()[i];
    ASSERT_EQ(message.channel, i % 3);
    ASSERT_EQ(message.sequence, i / 3);
    ASSERT_EQ(message.log_time, i * 1000000);
    ASSERT_EQ(message.publish_time, message.log_time);
    ASSERT_EQ(message.data.size(), i == 77 ? 5000 : i * 37 % 200);
    if (!message.data.empty()) {
      ASSERT_EQ(message.data.back(), static_cast<std::uint8_t>(i));
    }
  }
}

TEST_P(McapLayoutTest, GivesTheSameBytesForTheSameCalls) {
  write_many(path("_1"), GetParam().options);
  write_many(path("_2"), GetParam().options);
  EXPECT_EQ(read_file(path("_1")), read_file(path("_2")));
}

TEST_P(McapLayoutTest, HasAChecksumThatHoldsForTheWholeDataSection) {
  write_many(path(), GetParam().options);
  const std::string bytes = read_file(path());
  // The footer is the last record: 9 + 20 bytes, and the magic behind it. Its first number is where the
  // summary begins.
  std::uint64_t summary = 0;
  std::memcpy(&summary, bytes.data() + bytes.size() - 8 - 20, 8);
  const std::size_t data_end = summary - 9 - 4;
  EXPECT_EQ(bytes[data_end], 0x0F);
  EXPECT_EQ(bytes.substr(data_end + 9, 4), u32(crc(bytes.substr(0, data_end))));
}

/// How many messages are whole in the first `size` bytes, for each size: a message counts from the end of its
/// own record, or of its chunk's; how many a chunk holds is said by the indexes behind it.
std::vector<std::size_t> complete_messages(const std::string& bytes) {
  std::vector<std::size_t> complete(bytes.size() + 1, 0);
  std::size_t chunk_end = 0;
  for (std::size_t at = 8; at + 9 < bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 1, 8);
    const std::size_t end = at + 9 + length;
    if (bytes[at] == 0x05) ++complete[end];
    if (bytes[at] == 0x06) chunk_end = end;
    if (bytes[at] == 0x07) complete[chunk_end] += (length - 2 - 4) / 16;
    at = end;
  }
  for (std::size_t size = 1; size < complete.size(); ++size) complete[size] += complete[size - 1];
  return complete;
}

TEST_P(McapLayoutTest, CutAtAnyByteGivesExactlyItsCompleteRecords) {
  write_many(path(), GetParam().options, 60);
  const std::string bytes = read_file(path());
  const std::vector<std::size_t> complete = complete_messages(bytes);
  ASSERT_EQ(complete.back(), 60u);
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    write_file(path("_cut"), bytes.substr(0, size));
    const McapReader reader(path("_cut"));
    ASSERT_EQ(reader.messages().size(), complete[size]) << "after " << size << " bytes";
    ASSERT_EQ(reader.truncated(), size < bytes.size());
    for (std::size_t i = 0; i < complete[size]; ++i) ASSERT_EQ(reader.messages()[i].log_time, i * 1000000);
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, McapLayoutTest,
                         ::testing::Values(LayoutCase{"Stored", {.chunk_size = 1024}},
                                           LayoutCase{"Compressed", {.compress = true, .chunk_size = 1024}},
                                           LayoutCase{"Journal", {.journal = true, .chunk_size = 1024}}),
                         [](const auto& test) { return test.param.name; });

TEST_F(McapWriterTest, KeepsChunksWithinTheirSize) {
  write_many(path(), {.chunk_size = 2048});
  const std::string bytes = read_file(path());
  int chunks = 0;
  for (std::size_t at = 8; at + 9 < bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 1, 8);
    if (bytes[at] == 0x06) {
      std::uint64_t uncompressed = 0;
      std::memcpy(&uncompressed, bytes.data() + at + 9 + 16, 8);
      const bool holds_the_large_message = uncompressed > 5000;
      EXPECT_LE(holds_the_large_message ? 0u : uncompressed, 2048u);
      ++chunks;
    }
    at += 9 + length;
  }
  EXPECT_GT(chunks, 20);
}

TEST_F(McapWriterTest, WritesNothingBetweenTwoChunks) {
  McapWriter writer(path());
  const std::uint16_t a = writer.add_channel("/a", kSchema);
  const std::uint64_t before = writer.file_size();
  for (int i = 0; i < 500; ++i) put(writer, a, milliseconds(i), std::string(64, 'x'));
  EXPECT_EQ(writer.file_size(), before);
}

TEST_F(McapWriterTest, FlushesAJournalAtItsInterval) {
  McapWriter writer(path(), {.journal = true, .flush_interval = milliseconds(100)});
  const std::uint16_t a = writer.add_channel("/a", kSchema);
  for (int i = 0; i < 99; ++i) put(writer, a, milliseconds(i), "x");
  EXPECT_EQ(McapReader(path()).messages().size(), 0u);
  for (int i = 99; i < 150; ++i) put(writer, a, milliseconds(i), "x");
  EXPECT_EQ(McapReader(path()).messages().size(), 101u);
}

TEST_F(McapWriterTest, SaysWhichFileCannotBeMade) {
  try {
    McapWriter writer("/nowhere/at/all.mcap");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/at/all.mcap: cannot be made: No such file or directory");
  }
}

TEST_F(McapWriterTest, RefusesAChunkSizeBelowItsBound) {
  EXPECT_THROW(McapWriter(path(), {.chunk_size = 1023}), std::invalid_argument);
}

/// Lets no file of this process grow beyond a size, as a full disk would.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST_F(McapWriterTest, ReportsAFullDiskOnceAndLeavesAReadableFile) {
  std::vector<std::string> errors;
  {
    const FullDisk disk(10000);
    McapWriter writer(path(), {.chunk_size = 1024});
    const std::uint16_t a = writer.add_channel("/a", kSchema);
    for (int i = 0; i < 1000; ++i) {
      try {
        put(writer, a, milliseconds(i), std::string(100, 'x'));
      } catch (const std::runtime_error& error) {
        errors.emplace_back(error.what());
      }
    }
    writer.metadata("late", {});
    writer.close();
  }
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors.front(), path().string() +
                                ": writing failed: File too large; raise the limit, see `ulimit -f`, or name "
                                "another place on the command line");
  const McapReader reader(path());
  EXPECT_TRUE(reader.truncated());
  EXPECT_GT(reader.messages().size(), 40u);
  for (std::size_t i = 0; i < reader.messages().size(); ++i)
    ASSERT_EQ(reader.messages()[i].log_time, i * 1000000);
}

}  // namespace
}  // namespace ironbird::scenarios
