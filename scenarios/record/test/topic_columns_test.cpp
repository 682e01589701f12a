#include "scenarios/record/topic_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <stdexcept>

#include "scenarios/record/test/by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using namespace by_hand;  // NOLINT: this file writes bytes
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsNan;

const std::string kLittle("\0\1\0\0", 4);

struct Columns {
  std::vector<std::string> fields;
  std::map<std::string, std::vector<double>, std::less<>> numbers;
  std::map<std::string, std::vector<std::string>, std::less<>> texts;
};

Columns decode(const std::string& schema_text, const std::vector<std::string>& messages) {
  Allowance allowance(schema_text.size());
  const std::vector<Ros2MessageType> types = parse_ros2_schema("some_msgs/msg/Root", schema_text, allowance);
  TopicColumns topic(types, allowance);
  for (const std::string& message : messages) {
    topic.add({reinterpret_cast<const std::uint8_t*>(message.data()), message.size()});
  }
  Columns columns;
  topic.finish(columns.fields, columns.numbers, columns.texts);
  return columns;
}

TEST(TopicColumnsTest, ReadsEveryNumberType) {
  const Columns columns = decode(
      "bool a\nbyte b\nchar c\nint8 d\nuint8 e\nint16 f\nuint16 g\nint32 h\nuint32 i\nint64 j\nuint64 "
      "k\nfloat32 l\n"
      "float64 m\n",
      {kLittle + u8(1) + u8(2) + u8(3) + u8(0xFF) + u8(0xFF) + pad(1) + u16(0xFFFE) + u16(0xFFFE) + pad(2) +
       u32(0xFFFFFFFD) + u32(0xFFFFFFFD) + pad(4) + u64(~std::uint64_t{3}) + u64(5) + u32(0x3FC00000) +
       pad(4) + f64(0.1)});
  std::vector<double> values;
  for (const std::string& field : columns.fields) values.push_back(columns.numbers.at(field)[0]);
  EXPECT_THAT(values, ElementsAre(1, 2, 3, -1, 255, -2, 65534, -3, 4294967293.0, -4, 5, 1.5, 0.1));
}

TEST(TopicColumnsTest, NamesNestedArraysAndSequences) {
  const Columns columns = decode(
      "geometry_msgs/Vector3[2] pair\nfloat64[] list\n"
      "====\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\n",
      {kLittle + f64(1) + f64(2) + f64(3) + f64(4) + u32(0),
       kLittle + f64(5) + f64(6) + f64(7) + f64(8) + u32(2) + pad(4) + f64(9) + f64(10),
       kLittle + f64(1) + f64(2) + f64(3) + f64(4) + u32(1) + pad(4) + f64(11)});
  EXPECT_THAT(columns.fields,
              ElementsAre("pair[0].x", "pair[0].y", "pair[1].x", "pair[1].y", "list[0]", "list[1]"));
  EXPECT_THAT(columns.numbers.at("pair[1].x"), ElementsAre(3, 7, 3));
  EXPECT_THAT(columns.numbers.at("list[0]"), ElementsAre(IsNan(), 9, 11));
  EXPECT_THAT(columns.numbers.at("list[1]"), ElementsAre(IsNan(), 10, IsNan()));
}

TEST(TopicColumnsTest, ReadsWhatMayBeAbsentWithoutANumber) {
  const Columns columns =
      decode("Point[<=1] maybe\nfloat64[<=1] never\n====\nMSG: some_msgs/Point\nfloat64 x\nint32[<=2] few\n",
             {kLittle + u32(0) + u32(0), kLittle + u32(1) + pad(4) + f64(3) + u32(1) + u32(8) + u32(0),
              kLittle + u32(0) + u32(0)});
  EXPECT_THAT(columns.fields, ElementsAre("maybe.x", "maybe.few[0]", "never"));
  EXPECT_THAT(columns.numbers.at("maybe.x"), ElementsAre(IsNan(), 3, IsNan()));
  EXPECT_THAT(columns.numbers.at("maybe.few[0]"), ElementsAre(IsNan(), 8, IsNan()));
  EXPECT_THAT(columns.numbers.at("never"), ElementsAre(IsNan(), IsNan(), IsNan()));
}

TEST(TopicColumnsTest, ReadsTimesAsSecondsAndTextsApart) {
  const Columns columns = decode(
      "builtin_interfaces/Time stamp\nstring<=20 note\nstring[2] notes\nuint8 CONSTANT=3\nstring WORD=\"a # "
      "b\"\n",
      {kLittle + u32(2) + u32(500000000) + u32(3) + "hi" + u8(0) + pad(1) + u32(1) + u8(0) + pad(3) + u32(2) +
       "x" + u8(0)});
  EXPECT_THAT(columns.fields, ElementsAre("stamp"));
  EXPECT_THAT(columns.numbers.at("stamp"), ElementsAre(2.5));
  EXPECT_THAT(columns.texts.at("note"), ElementsAre("hi"));
  EXPECT_THAT(columns.texts.at("notes[0]"), ElementsAre(""));
  EXPECT_THAT(columns.texts.at("notes[1]"), ElementsAre("x"));
}

TEST(TopicColumnsTest, ReadsBigEndianMessages) {
  const std::string big("\0\0\0\0", 4);
  const Columns columns = decode("int32 a\nfloat64 b\n", {big + std::string("\0\0\1\2", 4) + pad(4) +
                                                          std::string("\x3F\xF0\0\0\0\0\0\0", 8)});
  EXPECT_THAT(columns.numbers.at("a"), ElementsAre(258));
  EXPECT_THAT(columns.numbers.at("b"), ElementsAre(1.0));
}

TEST(TopicColumnsTest, AlignsTheSecondEncodingToFour) {
  const std::string second("\0\7\0\0", 4);
  EXPECT_THAT(decode("int32 a\nfloat64 b\n", {second + u32(1) + f64(2)}).numbers.at("b"), ElementsAre(2.0));
}

TEST(TopicColumnsTest, UnderstandsNamesOfRosAndItsHeaders) {
  const Columns columns = decode(
      "# a comment\nHeader header\nsome_msgs/msg/Deep deep  # another\n\n====\nMSG: std_msgs/Header\n"
      "builtin_interfaces/Time stamp\nstring frame_id\n====\nMSG: some_msgs/Deep\nint32 n 7\n",
      {kLittle + u32(1) + u32(0) + u32(2) + "N" + u8(0) + pad(2) + u32(42)});
  EXPECT_THAT(columns.fields, ElementsAre("header.stamp", "deep.n"));
  EXPECT_THAT(columns.numbers.at("deep.n"), ElementsAre(42));
  EXPECT_THAT(columns.texts.at("header.frame_id"), ElementsAre("N"));
}

TEST(TopicColumnsTest, LeavesCapitalsOfOtherPeoplesCommentsAlone) {
  EXPECT_THAT(decode("float64 temperature  # Temperature: in kelvin\n", {}).fields,
              ElementsAre("temperature"));
}

TEST(TopicColumnsTest, KeepsPicturesOutOfTheColumns) {
  const std::string picture(5000, '\1');
  const Columns columns = decode("uint8[] data\nuint8 after\n", {kLittle + u32(5000) + picture + u8(9)});
  EXPECT_EQ(columns.fields.size(), 4096u + 1u);
  EXPECT_THAT(columns.numbers.at("after"), ElementsAre(9));
}

TEST(TopicColumnsTest, PassesOverWhatBecomesNoColumn) {
  const std::string many = u32(4097);
  const Columns columns = decode(
      "float64[] a\nbuiltin_interfaces/Time[] b\nP[] c\nstring[] d\nuint16 after\n====\nMSG: "
      "some_msgs/P\nuint8 x\nuint8[] y\n",
      {kLittle + many + pad(4) + std::string(4097 * 8, '\1') + many + std::string(4097 * 8, '\1') + many +
       [] {
         std::string points;
         for (int i = 0; i < 4097; ++i) points += u8(3) + pad(3) + u32(4) + std::string(4, '\1');
         return points;
       }() +
       many + std::string(4097 * 4, '\0') + u16(9)});
  EXPECT_THAT(columns.numbers.at("after"), ElementsAre(9));
  EXPECT_THAT(columns.numbers.at("c[4095].y[3]"), ElementsAre(1));
  EXPECT_FALSE(columns.numbers.contains("c[4096].x"));
}

TEST(TopicColumnsTest, ReadsNothingOfWhatHasNoMembersHoweverMany) {
  const Columns columns = decode(
      "Empty[18446744073709551615] many\nEmpty[] some\nEmpty[<=1] maybe\nfloat64[0] none\nuint8 after\n"
      "====\nMSG: some_msgs/Empty\nuint8 CONSTANT=1\n",
      {kLittle + u32(0xFFFFFFFF) + u32(1) + u8(9)});
  EXPECT_THAT(columns.fields, ElementsAre("after"));
  EXPECT_THAT(columns.numbers.at("after"), ElementsAre(9));
}

/// `depth` types, each of which holds the next one twice, and the last the field `last`.
std::string doubling(int depth, const std::string& last) {
  std::string text;
  for (int i = 0; i < depth; ++i) {
    const std::string next = "T" + std::to_string(i);
    text += next + " a\n" + next + " b\n====\nMSG: some_msgs/" + next + "\n";
  }
  return text + last;
}

TEST(TopicColumnsTest, ReadsNothingOfStructsWithoutMembersThatDouble) {
  EXPECT_THAT(decode(doubling(60, ""), {kLittle}).fields, ElementsAre());
}

TEST(TopicColumnsTest, RefusesMessagesThatFillFarMoreThanTheyAre) {
  std::vector<std::string> messages{kLittle + u32(4096) + std::string(4096, '\1')};
  for (int i = 0; i < 100; ++i) messages.push_back(kLittle + u32(0));
  EXPECT_EQ(decode("uint8[] data\n", messages).numbers.at("data[4095]").size(), 101u);
  for (int i = 0; i < 500; ++i) messages.push_back(kLittle + u32(0));
  EXPECT_THROW(decode("uint8[] data\n", messages), std::runtime_error);
}

struct WrongMessageCase {
  const char* name;
  std::string schema;
  std::string message;
  const char* reason;
};
class WrongMessageTest : public ::testing::TestWithParam<WrongMessageCase> {};

TEST_P(WrongMessageTest, IsRefusedWithItsReason) {
  try {
    decode(GetParam().schema, {GetParam().message});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().reason));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Messages, WrongMessageTest,
    ::testing::Values(
        WrongMessageCase{"NoHeader", "bool a\n", "\0", "is shorter than its header"},
        WrongMessageCase{"UnknownEncoding", "bool a\n", std::string("\0\3\0\0\1", 5),
                         "has an unknown encoding"},
        WrongMessageCase{"TooShort", "float64 a\n", kLittle + u32(1), "ends too early"},
        WrongMessageCase{"TooLongText", "string a\n", kLittle + u32(0xFFFFFFFF) + "x", "ends too early"},
        WrongMessageCase{"TwoOfOne", "bool[<=1] a\n", kLittle + u32(2) + u8(1) + u8(1),
                         "has 2 elements in a"},
        WrongMessageCase{"UnknownType", "Point p\n", kLittle,
                         "type Point of a field of some_msgs/Root is not defined"},
        WrongMessageCase{"NoName", "float64\n", kLittle, "no field name in 'float64'"},
        WrongMessageCase{"NoLength", "float64[x] a\n", kLittle, "no length in 'float64[x] a'"},
        WrongMessageCase{"CutShortInLongArray", "float64[1000000000000] a\n", kLittle + u32(1),
                         "ends too early"},
        WrongMessageCase{"ArrayOfArrays",
                         "A[4000] a\n====\nMSG: some_msgs/A\nB[<=1] b\n====\nMSG: "
                         "some_msgs/B\nfloat64[4000] c\n",
                         kLittle, "the columns come to more than 16 MiB in memory"},
        WrongMessageCase{"Doubling", doubling(60, "bool a\n"), kLittle,
                         "the columns come to more than 16 MiB in memory"},
        WrongMessageCase{"TooDeep", doubling(64, "bool a\n"), kLittle, "types are nested more than 64 deep"},
        WrongMessageCase{"LongNameOfMany",
                         "A[4096] " + std::string(4000, 'a') + "\n====\nMSG: some_msgs/A\nbool b\n", kLittle,
                         "the columns come to more than"},
        WrongMessageCase{"Endless", "A a\n====\nMSG: some_msgs/A\nA a\n", kLittle,
                         "type some_msgs/A contains itself"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace ironbird::scenarios
