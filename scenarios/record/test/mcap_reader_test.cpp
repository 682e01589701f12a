#include "scenarios/record/mcap_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <stdexcept>

#include "scenarios/record/log.hpp"
#include "scenarios/record/test/by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using namespace by_hand;  // NOLINT: this file writes bytes
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path file_with(const std::string& bytes) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string("reader_") + test->name() + ".mcap";
  for (char& c : name) c = c == '/' ? '_' : c;
  return write_file(std::filesystem::path(::testing::TempDir()) / name, bytes);
}

const std::string kCdr("\0\1\0\0", 4);
const std::string kOne = kCdr + u64(0x3FF0000000000000);    // 1.0
const std::string kMinus = kCdr + u64(0xC000000000000000);  // -2.0
const std::string kNames = schema(1, "some_msgs/msg/Number", "float64 value\n") + channel(3, 1, "/number");

std::string compressed(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  return out;
}

std::string zstd_chunk(const std::string& records) {
  return chunk(7, 9, compressed(records), crc(records), "zstd", records.size());
}

/// A chunk of a few hundred bytes: records of a kind that nobody knows, without content.
std::string chunk_of_zeros(std::size_t records) {
  const std::string zeros(9 * records, '\0');
  return chunk(0, 0, compressed(zeros), 0, "zstd", zeros.size());
}

struct FileCase {
  const char* name;
  std::string bytes;
};

/// The same two messages in every form that the format leaves open.
std::vector<FileCase> forms() {
  const std::string start = magic() + header();
  const std::string one = message(3, 0, 7, kOne);
  const std::string two = message(3, 1, 9, kMinus);
  const std::string data_end = record(0x0F, u32(0));
  const std::string end = data_end + footer(0, 0, 0) + magic();
  const std::string records = kNames + one + two;
  const std::string index = record(0x07, u16(3) + text(u64(7) + u64(kNames.size())));
  const std::string attachment =
      record(0x09, u64(1) + u64(1) + text("photo") + text("image/png") + u64(3) + "png" + u32(0));
  return {{"NoChunksNoSummary", start + records + end},
          {"StoredChunk", start + chunk(7, 9, records, crc(records)) + end},
          {"ChunkWithoutChecksum", start + chunk(7, 9, records, 0) + end},
          {"CompressedChunk", start + zstd_chunk(records) + end},
          {"TwoChunks", start + zstd_chunk(kNames + one) + index + chunk(9, 9, two, crc(two)) + end},
          {"ChannelsOutsideTheChunk", start + kNames + zstd_chunk(one + two) + end},
          {"EmptyChunk", start + chunk(0, 0, "", 0) + records + end},
          {"NoDataEnd", start + records + footer(0, 0, 0) + magic()},
          {"SummaryRepeatsChannels", start + records + data_end + kNames + footer(0, 0, 0) + magic()},
          {"Attachment", start + attachment + records + end},
          {"MessageIndexes", start + chunk(7, 9, records, crc(records)) + index + end},
          {"UnknownRecords", start + record(0x90, "private") + records + record(0x33, "") + end},
          {"LongerRecords",
           start + record(0x03, schema(1, "some_msgs/msg/Number", "float64 value\n").substr(9) + "more") +
               channel(3, 1, "/number") + one + two + end}};
}

class McapFormTest : public ::testing::TestWithParam<FileCase> {};

TEST_P(McapFormTest, IsReadWhole) {
  const Log log = Log::read(file_with(GetParam().bytes));
  EXPECT_FALSE(log.truncated());
  EXPECT_THAT(log.topics(), ElementsAre("/number"));
  const LogTopic* topic = log.topic("/number");
  ASSERT_NE(topic, nullptr);
  EXPECT_THAT(topic->time(), ElementsAre(7e-9, 9e-9));
  EXPECT_THAT(topic->column("value"), ElementsAre(1.0, -2.0));
}

TEST_P(McapFormTest, OpensWhenCutAtAnyByte) {
  for (std::size_t size = 0; size < GetParam().bytes.size(); ++size) {
    const McapReader reader(file_with(GetParam().bytes.substr(0, size)));
    ASSERT_TRUE(reader.truncated()) << size;
    ASSERT_LE(reader.messages().size(), 2u);
  }
}

TEST_P(McapFormTest, SurvivesAnyChangedByte) {
  for (std::size_t at = 8; at < GetParam().bytes.size(); ++at) {
    std::string bytes = GetParam().bytes;
    bytes[at] = static_cast<char>(~bytes[at]);
    try {
      const Log log = Log::read(file_with(bytes));
      for (const std::string& name : log.topics()) log.topic(name);
    } catch (const std::runtime_error& error) {
      ASSERT_THAT(error.what(), HasSubstr(".mcap: ")) << at;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, McapFormTest, ::testing::ValuesIn(forms()),
                         [](const auto& test) { return test.param.name; });

struct WrongCase {
  const char* name;
  std::string bytes;
  std::string message;
};

std::vector<WrongCase> wrong_files() {
  const std::string start = magic() + header();
  const std::string records = kNames + message(3, 0, 7, kOne);
  return {
      {"NoLog", "SQLite format 3", "is not a log: it does not begin like an MCAP file"},
      {"DamagedChunk", start + chunk(7, 7, records, crc(records) ^ 1u),
       "byte 37: a chunk is damaged: its checksum is wrong"},
      {"Lz4", start + chunk(7, 7, records, 0, "lz4", records.size()),
       "byte 37: a chunk is compressed with 'lz4', readable are zstd and none"},
      {"NameInTwoLines", start + chunk(7, 7, records, 0, "l\nz", records.size()),
       "byte 37: a chunk is compressed with 'l z', readable are zstd and none"},
      {"DamagedCompression", start + chunk(7, 7, "not zstd at all", 0, "zstd", 50),
       "byte 37: a chunk is damaged: "},
      {"WrongSize", start + chunk(7, 7, compressed(records), 0, "zstd", records.size() + 1),
       "byte 37: a chunk has another size than it says"},
      {"HugeChunk", start + chunk(7, 7, compressed(records), 0, "zstd", std::uint64_t{1} << 60),
       "byte 37: a chunk claims 1152921504606846976 bytes"},
      {"MoreThanCompressionCan", start + chunk(7, 7, compressed("few"), 0, "zstd", 1u << 20),
       "byte 37: a chunk claims 1048576 bytes, compressed to 12"},
      {"SmallFileOfMuch", start + chunk_of_zeros(1000000) + chunk_of_zeros(1000000),
       "byte " + std::to_string((start + chunk_of_zeros(1000000)).size()) +
           ": what it holds comes to more than 16 MiB in memory, too much for a file of "},
      {"ChunkInChunk", start + chunk(7, 7, chunk(7, 7, "", 0), 0), "byte 37: a chunk lies inside a chunk"},
      {"CutInsideChunk", start + chunk(7, 7, records.substr(0, records.size() - 1), 0),
       "byte 37: a chunk ends inside a record"},
      {"ShortRecord", start + record(0x03, u16(1)), "byte 37: a record is shorter than its kind needs"},
      {"MessageWithoutChannel", start + message(3, 0, 7, kOne),
       "byte 37: a message comes before its channel"}};
}

class McapWrongFileTest : public ::testing::TestWithParam<WrongCase> {};

TEST_P(McapWrongFileTest, IsRefusedWithFileAndReason) {
  const auto file = file_with(GetParam().bytes);
  try {
    McapReader reader(file);
    FAIL() << "was read";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.string() + ": " + GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, McapWrongFileTest, ::testing::ValuesIn(wrong_files()),
                         [](const auto& test) { return test.param.name; });

TEST(McapReaderTest, NamesAFileThatIsMissing) {
  try {
    McapReader reader("/nowhere/flight.mcap");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/flight.mcap: cannot be opened: there is no such file");
  }
}

TEST(McapReaderTest, ReadsAChunkThatIsNearlyNothingCompressed) {
  EXPECT_TRUE(McapReader(file_with(magic() + header() + chunk_of_zeros(1000000))).messages().empty());
}

TEST(McapReaderTest, CountsWhatSmallRecordsBecome) {
  std::string records = kNames;
  for (int i = 0; i < 300000; ++i) records += message(3, 0, 7, "");
  EXPECT_LT(records.size(), 10'000'000u);
  EXPECT_THROW(McapReader(file_with(magic() + zstd_chunk(records))), std::runtime_error);
}

TEST(McapReaderTest, GivesHeaderChannelsAndMetadata) {
  const std::string map = text(text("k") + text("v"));
  const McapReader reader(file_with(magic() + header() + schema(1, "n", "d") +
                                    record(0x04, u16(2) + u16(1) + text("/t") + text("cdr") + map) +
                                    record(0x0C, text("run") + map) + record(0x0F, u32(0)) + footer(0, 0, 0) +
                                    magic()));
  EXPECT_EQ(reader.profile(), "ros2");
  EXPECT_EQ(reader.writer_name(), "ironbird");
  EXPECT_EQ(reader.schemas().at(1).text, "d");
  EXPECT_EQ(reader.channels().at(2).topic, "/t");
  EXPECT_EQ(reader.channels().at(2).metadata.at("k"), "v");
  EXPECT_EQ(reader.metadata().at("run").at("k"), "v");
}

}  // namespace
}  // namespace ironbird::scenarios
