// ULog files made by hand: every kind of message, and every kind of damage.

#include "scenarios/replay/ulog_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/test/ulog_by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using test::UlogByHand;
using testing::ElementsAre;
using testing::HasSubstr;

/// A log with one topic and these records of it.
UlogByHand log_of(int records) {
  UlogByHand log;
  log.format("point:uint64_t timestamp;float[2] xy;bool good;").subscribe(0, 7, "point");
  for (int k = 0; k < records; ++k)
    log.record(7, std::uint64_t(1000 + k), 0.5F * static_cast<float>(k), -1.0F, std::uint8_t(k % 2));
  return log;
}

std::string refusal(const std::vector<std::uint8_t>& bytes) {
  try {
    UlogFile::from(bytes, "some.ulg");
    return "it was read";
  } catch (const UserError& error) {
    return error.what();
  }
}

TEST(UlogFileTest, ReadsRecordsByTheNamesOfTheirFields) {
  const UlogFile file = log_of(3).read();
  EXPECT_EQ(file.start(), 112U);
  const UlogSeries* const point = file.find("point");
  ASSERT_NE(point, nullptr);
  ASSERT_EQ(point->size(), 3U);
  const auto stamp = point->find("timestamp");
  const auto xy = point->find("xy");
  const auto y = point->find("xy[1]");
  const auto good = point->find("good");
  ASSERT_TRUE(stamp && xy && y && good);
  EXPECT_EQ(xy->count, 2U);
  EXPECT_EQ(point->integer(2, *stamp), 1002);
  EXPECT_EQ(point->number(2, *xy, 0), 1.0);
  EXPECT_EQ(point->number(2, *y), -1.0);
  EXPECT_EQ(point->number(1, *good), 1.0);
  EXPECT_FALSE(point->find("xy[2]"));
  EXPECT_FALSE(point->find("z"));
  EXPECT_FALSE(point->find("xy.x"));
  EXPECT_EQ(file.find("point", 1), nullptr);
  EXPECT_TRUE(file.complaints().empty());
}

TEST(UlogFileTest, ReadsEveryTypeToItsLastBit) {
  UlogByHand log;
  log.format(
      "all:uint64_t timestamp;int8_t a;uint8_t b;int16_t c;uint16_t d;int32_t e;uint32_t f;int64_t "
      "g;uint64_t h;float i;double j;char k;");
  log.subscribe(0, 1, "all");
  log.record(1, std::uint64_t{5}, std::int8_t{-128}, std::uint8_t{255}, std::int16_t{-32768},
             std::uint16_t{65535}, std::int32_t{-2147483647}, std::uint32_t{4294967295U},
             std::int64_t{-9007199254740993}, ~std::uint64_t{0}, 0.1F, 0.1, 'x');
  const UlogFile file = log.read();
  const UlogSeries& all = *file.find("all");
  const auto at = [&](const char* name) { return *all.find(name); };
  EXPECT_EQ(all.number(0, at("a")), -128.0);
  EXPECT_EQ(all.number(0, at("b")), 255.0);
  EXPECT_EQ(all.number(0, at("c")), -32768.0);
  EXPECT_EQ(all.number(0, at("d")), 65535.0);
  EXPECT_EQ(all.number(0, at("e")), -2147483647.0);
  EXPECT_EQ(all.number(0, at("f")), 4294967295.0);
  EXPECT_EQ(all.integer(0, at("g")), -9007199254740993);
  EXPECT_EQ(all.integer(0, at("h")), -1) << "the bits of 2^64 - 1";
  EXPECT_EQ(all.number(0, at("i")), static_cast<double>(0.1F));
  EXPECT_EQ(all.number(0, at("j")), 0.1);
  EXPECT_EQ(all.integer(0, at("k")), 'x');
}

TEST(UlogFileTest, NeverCastsARealNumberThatIsNoWholeOne) {
  UlogByHand log;
  log.format("r:uint64_t timestamp;double v;").subscribe(0, 1, "r");
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e300, 2.9})
    log.record(1, std::uint64_t{1}, value);
  const UlogFile file = log.read();
  const UlogSeries& r = *file.find("r");
  const UlogPlace v = *r.find("v");
  EXPECT_EQ(r.integer(0, v), 0);
  EXPECT_EQ(r.integer(1, v), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(r.integer(2, v), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(r.integer(3, v), 2);
}

TEST(UlogFileTest, KeepsPublishersOfOneTopicApart) {
  UlogByHand log;
  log.format("m:uint64_t timestamp;float v;").subscribe(0, 1, "m").subscribe(1, 2, "m");
  log.record(1, std::uint64_t{1}, 10.0F)
      .record(2, std::uint64_t{1}, 20.0F)
      .record(1, std::uint64_t{2}, 11.0F);
  const UlogFile file = log.read();
  EXPECT_EQ(file.find("m", 0)->size(), 2U);
  ASSERT_EQ(file.find("m", 1)->size(), 1U);
  EXPECT_EQ(file.find("m", 1)->number(0, *file.find("m", 1)->find("v")), 20.0);
}

TEST(UlogFileTest, FollowsNestedTypesThatAreDefinedLater) {
  UlogByHand log;
  log.format("outer:uint64_t timestamp;inner[2] part;uint8_t after;uint8_t[7] _padding0;");
  log.format("inner:float a;uint8_t b;uint8_t[3] _padding0;");
  log.subscribe(0, 3, "outer");
  log.record(3, std::uint64_t{9}, 1.5F, std::uint32_t{7}, 2.5F, std::uint32_t{8}, std::uint8_t{42});
  const UlogFile file = log.read();
  const UlogSeries& outer = *file.find("outer");
  ASSERT_EQ(outer.size(), 1U) << "padding at the end of the outermost is not written";
  EXPECT_EQ(outer.number(0, *outer.find("part[1].a")), 2.5);
  EXPECT_EQ(outer.number(0, *outer.find("part[1].b")), 8.0) << "that of the inner one is";
  EXPECT_EQ(outer.number(0, *outer.find("part.a")), 1.5);
  EXPECT_EQ(outer.number(0, *outer.find("after")), 42.0);
  EXPECT_FALSE(outer.find("part[2].a"));
  EXPECT_FALSE(outer.find("part")) << "is not a number";
}

TEST(UlogFileTest, HasNoRecordsOfFormatsThatGoRoundInACircleOrAreTooLong) {
  UlogByHand log;
  log.format("a:uint64_t timestamp;b x;").format("b:a y;");
  log.format("long:uint64_t timestamp;uint8_t[65536] x;")
      .format("none:uint64_t timestamp;strange x;")
      .format("empty:");
  log.subscribe(0, 1, "a")
      .subscribe(0, 2, "long")
      .subscribe(0, 3, "none")
      .subscribe(0, 4, "empty")
      .subscribe(0, 5, "unheard");
  for (std::uint16_t id = 1; id <= 5; ++id) log.record(id, std::uint64_t{1});
  const UlogFile file = log.read();
  for (const char* topic : {"a", "long", "none", "empty", "unheard"})
    EXPECT_EQ(file.find(topic)->size(), 0U) << topic;
  EXPECT_EQ(file.damage().homeless_records, 5U);
}

TEST(UlogFileTest, ReadsParametersTheirChangesAndDefaults) {
  UlogByHand log;
  log.keyed('P', "int32_t SYS_HITL", std::int32_t{0}).keyed('P', "float MPC_XY_P", 0.95F);
  std::vector<std::uint8_t> defaults{3};
  const auto key = UlogByHand::bytes_of("float MPC_XY_P");
  defaults.push_back(static_cast<std::uint8_t>(key.size()));
  defaults.insert(defaults.end(), key.begin(), key.end());
  defaults.insert(defaults.end(), {0, 0, 0x80, 0x3F});
  log.message('Q', defaults);
  log.format("p:uint64_t timestamp;").subscribe(0, 1, "p").record(1, std::uint64_t{4});
  const std::size_t before = log.size();
  log.keyed('P', "float MPC_XY_P", 1.25F);
  const UlogFile file = log.read();
  EXPECT_EQ(file.parameter("SYS_HITL"), 0.0);
  EXPECT_EQ(file.parameter("MPC_XY_P"), static_cast<double>(0.95F)) << "as it was at the beginning";
  EXPECT_FALSE(file.parameter("MPC_Z_P"));
  ASSERT_EQ(file.changes().size(), 1U);
  EXPECT_EQ(std::get<float>(file.changes()[0].value), 1.25F);
  EXPECT_EQ(file.changes()[0].after, before);
  EXPECT_EQ(std::get<float>(file.firmware_defaults().at("MPC_XY_P")), 1.0F);
  EXPECT_EQ(std::get<float>(file.vehicle_defaults().at("MPC_XY_P")), 1.0F);
}

TEST(UlogFileTest, ReadsInformationListsTextsAndDropouts) {
  UlogByHand log;
  log.keyed('I', "char[3] sys_name", "PX4").keyed('I', "uint32_t ver_sw_release", std::uint32_t{0x010D03FF});
  const auto piece = [&log](std::uint8_t goes_on, std::string_view text) {
    const std::string key = "char[" + std::to_string(text.size()) + "] perf";
    std::vector<std::uint8_t> content{goes_on, static_cast<std::uint8_t>(key.size())};
    for (const char c : key) content.push_back(static_cast<std::uint8_t>(c));
    for (const char c : text) content.push_back(static_cast<std::uint8_t>(c));
    log.message('M', content);
  };
  piece(0, "one ");
  piece(1, "and more");
  piece(0, "two");
  std::vector<std::uint8_t> text{'4', 1, 0, 0, 0, 0, 0, 0, 0, 'h', 'i', '\n', '!'};
  log.message('L', text);
  text.insert(text.begin() + 1, {5, 0});
  log.message('C', text).message('O', {50, 0}).message('O', {7, 1}).sync().message('R', {1, 0});
  const UlogFile file = log.read();
  EXPECT_EQ(file.information().at("sys_name"), "PX4");
  EXPECT_EQ(file.information().at("ver_sw_release"), std::to_string(0x010D03FF));
  EXPECT_THAT(file.lists().at("perf"), ElementsAre("one and more", "two"));
  ASSERT_EQ(file.texts().size(), 2U);
  EXPECT_EQ(file.texts()[0].text, "hi !") << "on one line";
  EXPECT_EQ(file.texts()[0].level, '4');
  EXPECT_EQ(file.texts()[1].tag, 5);
  EXPECT_EQ(file.damage().dropouts, 2U);
  EXPECT_EQ(file.damage().dropout_milliseconds, 50U + 7U + 256U);
  EXPECT_THAT(file.complaints(), ElementsAre("the autopilot's logger lost data 2 times, 313 ms together"));
}

TEST(UlogFileTest, ReadsAppendedDataAndTheMessageBeforeItThatWasCut) {
  UlogByHand log;
  log.flags(1).format("p:uint64_t timestamp;").subscribe(0, 1, "p").record(1, std::uint64_t{1});
  log.raw({200, 0, 'D', 1, 0, 9, 9});  // cut where the crash dump begins
  const std::uint64_t begin = log.size();
  log.record(1, std::uint64_t{2}).record(1, std::uint64_t{3});
  std::memcpy(log.bytes().data() + 16 + 3 + 16, &begin, sizeof begin);
  const UlogFile file = log.read();
  EXPECT_EQ(file.find("p")->size(), 3U);
  EXPECT_TRUE(file.complaints().empty());
}

TEST(UlogFileTest, DoesWithoutAppendedDataThatCannotBeThere) {
  for (const std::uint64_t begin : {std::uint64_t{3}, std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
    UlogByHand log;
    log.flags(1, begin).format("p:uint64_t timestamp;").subscribe(0, 1, "p").record(1, std::uint64_t{1});
    const UlogFile file = log.read();
    EXPECT_EQ(file.find("p")->size(), 1U);
    EXPECT_EQ(file.damage().faulty_messages, 1U);
  }
}

TEST(UlogFileTest, RefusesWhatItMustNotOrCannotRead) {
  EXPECT_EQ(refusal({}), "some.ulg: is empty; was the log copied to its end?");
  EXPECT_EQ(refusal({'U', 'L', 'o', 'X'}), "some.ulg: is not a ULog: it does not begin like one");
  EXPECT_THAT(refusal({'U', 'L', 'o', 'g', 1}), HasSubstr("is cut after 5 bytes"));
  UlogByHand later;
  later.flags(2);
  EXPECT_THAT(refusal(later.bytes()), HasSubstr("a kind that came later"));
  EXPECT_THROW(UlogFile::read("/no/such.ulg"), UserError);
  EXPECT_THROW(UlogFile::read("/tmp"), UserError);
}

TEST(UlogFileTest, OpensEveryTruncationAndReadsWhatIsWholeInIt) {
  const UlogByHand whole = log_of(20);
  std::vector<std::uint8_t> bytes;
  std::size_t before = 0;
  UlogByHand copy = whole;
  for (std::size_t size = 16; size <= copy.size(); ++size) {
    bytes.assign(copy.bytes().begin(), copy.bytes().begin() + static_cast<std::ptrdiff_t>(size));
    const UlogFile file = UlogFile::from(bytes, "cut.ulg");
    const UlogSeries* const point = file.find("point");
    const std::size_t records = point == nullptr ? 0 : point->size();
    EXPECT_GE(records, before);
    EXPECT_LE(records, before + 1);
    before = records;
    EXPECT_EQ(file.damage().skipped_bytes, 0U);
  }
  EXPECT_EQ(before, 20U);
}

TEST(UlogFileTest, GoesOnBehindDamageWithAndWithoutSync) {
  for (const bool has_sync : {true, false}) {
    UlogByHand log = log_of(5);
    log.raw(std::vector<std::uint8_t>(37, 0xFF));
    if (has_sync) log.sync();
    for (int k = 0; k < 6; ++k) log.record(7, std::uint64_t(2000 + k), 0.0F, 0.0F, std::uint8_t{0});
    const UlogFile file = log.read();
    EXPECT_EQ(file.find("point")->size(), 11U) << has_sync;
    EXPECT_EQ(file.damage().skipped_bytes, 37U);
    EXPECT_EQ(file.damage().skipped_places, 1);
    EXPECT_THAT(file.complaints(), ElementsAre("it is damaged in 1 place: 37 bytes passed over"));
  }
}

TEST(UlogFileTest, PassesOverMessagesThatItDoesNotKnow) {
  UlogByHand log = log_of(2);
  const auto sound = [&log] {
    for (int k = 0; k < 4; ++k) log.record(7, std::uint64_t{9}, 0.0F, 0.0F, std::uint8_t{0});
  };
  log.message('Z', {1, 2, 3});
  sound();
  log.record(7, std::uint64_t{9});  // too short
  sound();
  log.record(99, std::uint64_t{9});
  sound();
  const UlogFile file = log.read();
  EXPECT_EQ(file.find("point")->size(), 14U);
  EXPECT_EQ(file.damage().unknown_messages, 1U);
  EXPECT_EQ(file.damage().misfit_records, 1U);
  EXPECT_EQ(file.damage().homeless_records, 1U);
}

// Of every byte that is spoiled at most a few records are lost, and reading never fails.
TEST(UlogFileTest, LosesLittleToASingleFalseByte) {
  UlogByHand whole = log_of(100);
  std::mt19937 random(1);
  const std::size_t data = whole.size() - 100 * 22;
  for (int k = 0; k < 2000; ++k) {
    std::vector<std::uint8_t> bytes = whole.bytes();
    const std::size_t place = data + random() % (bytes.size() - data);
    bytes[place] ^= static_cast<std::uint8_t>(1U << random() % 8U);
    const UlogFile file = UlogFile::from(bytes, "spoiled.ulg");
    EXPECT_GE(file.find("point")->size(), 90U) << "byte " << place;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
