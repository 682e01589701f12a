#include "hil_bridge/rosflight/dialect.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace ironbird::hil_bridge::rosflight {
namespace {

TEST(DialectTest, ChecksTheDigitsAsEveryCrc16Mcrf4xx) {
  std::uint16_t crc = kCrcStart;
  for (const char digit : std::string_view("123456789")) crc = crc_of(crc, static_cast<std::uint8_t>(digit));
  EXPECT_EQ(crc, 0x6F91);
}

/// The catalogue of the link as its own generator gives it, written down by hand.
constexpr MessageInfo kCatalogue[] = {{0, "HEARTBEAT", 9, 50},
                                      {20, "PARAM_REQUEST_READ", 20, 214},
                                      {21, "PARAM_REQUEST_LIST", 2, 159},
                                      {22, "PARAM_VALUE", 25, 220},
                                      {23, "PARAM_SET", 23, 168},
                                      {31, "ATTITUDE_QUATERNION", 32, 246},
                                      {65, "RC_CHANNELS", 42, 118},
                                      {111, "TIMESYNC", 16, 34},
                                      {180, "OFFBOARD_CONTROL", 43, 90},
                                      {181, "SMALL_IMU", 36, 67},
                                      {182, "SMALL_MAG", 12, 218},
                                      {183, "SMALL_BARO", 12, 206},
                                      {184, "DIFF_PRESSURE", 12, 169},
                                      {187, "SMALL_RANGE", 13, 60},
                                      {188, "ROSFLIGHT_CMD", 1, 249},
                                      {189, "ROSFLIGHT_CMD_ACK", 2, 113},
                                      {190, "ROSFLIGHT_OUTPUT_RAW", 64, 181},
                                      {191, "ROSFLIGHT_STATUS", 11, 12},
                                      {192, "ROSFLIGHT_VERSION", 50, 134},
                                      {193, "ROSFLIGHT_AUX_CMD", 70, 1},
                                      {195, "EXTERNAL_ATTITUDE", 16, 65},
                                      {196, "ROSFLIGHT_HARD_ERROR", 16, 10},
                                      {197, "ROSFLIGHT_GNSS", 66, 221},
                                      {199, "ROSFLIGHT_BATTERY_STATUS", 8, 48},
                                      {253, "STATUSTEXT", 51, 83}};

TEST(DialectTest, ComputesLengthAndCheckByteOfEveryMessage) {
  ASSERT_EQ(kDialect.size(), std::size(kCatalogue));
  for (std::size_t k = 0; k < kDialect.size(); ++k) {
    EXPECT_EQ(kDialect[k].id, kCatalogue[k].id);
    EXPECT_EQ(kDialect[k].name, kCatalogue[k].name);
    EXPECT_EQ(kDialect[k].length, kCatalogue[k].length) << kDialect[k].name;
    EXPECT_EQ(kDialect[k].crc_extra, kCatalogue[k].crc_extra) << kDialect[k].name;
  }
}

template <class M>
std::uint8_t offset(std::string_view name) {
  for (const WireField& field : kWireFields<M>) {
    if (field.name == name) return field.offset;
  }
  return 255;
}

TEST(DialectTest, KnowsThePlaceOfEachField) {
  EXPECT_EQ(offset<Heartbeat>("mavlink_version"), 8);
  EXPECT_EQ(offset<ParamRequestRead>("param_id"), 4);
  EXPECT_EQ(offset<ParamValue>("param_type"), 24);
  EXPECT_EQ(offset<ParamSet>("param_id"), 6);
  EXPECT_EQ(offset<AttitudeQuaternion>("rollspeed"), 20);
  EXPECT_EQ(offset<RcChannels>("chan1_raw"), 4);
  EXPECT_EQ(offset<RcChannels>("chan18_raw"), 38);
  EXPECT_EQ(offset<RcChannels>("rssi"), 41);
  EXPECT_EQ(offset<OffboardControl>("ignore"), 40);
  EXPECT_EQ(offset<SmallImu>("temperature"), 32);
  EXPECT_EQ(offset<RosflightOutputRaw>("values"), 8);
  EXPECT_EQ(offset<RosflightStatus>("control_mode"), 10);
  EXPECT_EQ(offset<RosflightAuxCmd>("type_array"), 56);
  EXPECT_EQ(offset<RosflightHardError>("doRearm"), 12);
  EXPECT_EQ(offset<RosflightGnss>("nanos"), 32);
  EXPECT_EQ(offset<RosflightGnss>("num_sat"), 65);
  EXPECT_EQ(offset<Statustext>("text"), 1);
}

/// Described in an order that is not that of the wire.
struct Mixed {
  std::uint8_t small{};
  std::array<std::uint16_t, 3> several{};
  double large{};
  std::uint8_t last{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("small", self.small, "1", "");
    visit("several", self.several, "1", "");
    visit("large", self.large, "1", "");
    visit("last", self.last, "1", "");
  }
};

TEST(DialectTest, SortsFieldsByTheSizeOfTheirElementsAndKeepsEqualOnesInOrder) {
  constexpr auto fields = kWireFields<Mixed>;
  constexpr std::string_view kOrder[] = {"large", "several", "small", "last"};
  constexpr int kOffsets[] = {0, 8, 14, 15};
  for (std::size_t k = 0; k < fields.size(); ++k) {
    EXPECT_EQ(fields[k].name, kOrder[k]);
    EXPECT_EQ(fields[k].offset, kOffsets[k]);
  }
  EXPECT_EQ(kPayloadLength<Mixed>, 16);
}

TEST(DialectTest, FindsMessagesByNumber) {
  EXPECT_EQ(find_message(197)->name, "ROSFLIGHT_GNSS");
  EXPECT_EQ(find_message(185), nullptr);
  EXPECT_EQ(find_message(255), nullptr);
}

TEST(VocabularyTest, ReadsAndWritesFieldsThatAreFullAndFieldsThatAreNot) {
  constexpr std::array<char, 16> kFull = field_of<16>("MOTOR_RESISTANCE");
  static_assert(text_of(kFull) == "MOTOR_RESISTANCE");
  constexpr std::array<char, 16> kShort = field_of<16>("SYS_ID");
  static_assert(text_of(kShort) == "SYS_ID");
  constexpr std::array<char, 4> kCut = field_of<4>("SYS_ID");
  EXPECT_EQ(text_of(kCut), "SYS_");
  EXPECT_EQ(kShort.back(), '\0');
}

}  // namespace
}  // namespace ironbird::hil_bridge::rosflight
