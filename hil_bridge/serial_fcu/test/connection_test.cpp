#include "hil_bridge/serial_fcu/connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "hil_bridge/serial_fcu/test/served_unit.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::DeskLink;

void ignore(const rosflight::Message&) {}

rosflight::RosflightVersion version(std::string_view text) {
  rosflight::RosflightVersion message;
  std::copy(text.begin(), text.end(), message.version.begin());
  return message;
}

TEST(ConnectionTest, IsReadyWhenVersionAndParametersAreKnown) {
  DeskLink link;
  EXPECT_EQ(link.fcu().connection().state(), ConnectionState::kSilent);
  link.until(seconds(2), [&] { return link.fcu().connection().state() == ConnectionState::kReady; });
  const Connection& connection = link.fcu().connection();
  EXPECT_EQ(connection.state(), ConnectionState::kReady);
  EXPECT_EQ(connection.version(), "v2.0.1-ironbird");
  EXPECT_TRUE(connection.imu_alive(link.now()));
  EXPECT_TRUE(connection.radio_alive(link.now()));
  link.until(seconds(1), [] { return false; });
  EXPECT_TRUE(connection.heartbeat_alive(link.now()));
}

TEST(ConnectionTest, RefusesAUnitWithAnotherNumberOfParameters) {
  Connection connection;
  connection.begin(Time{});
  connection.take(version("v2.0.0-beta"), milliseconds(1));
  connection.take(rosflight::ParamValue{{1}, 251, 0, rosflight::field_of<16>("A"), 6}, milliseconds(2));
  EXPECT_EQ(connection.state(), ConnectionState::kRefused);
  EXPECT_EQ(
      connection.refusal(),
      "the unit has 251 parameters, ROSflight 2.0 has 333; it calls itself v2.0.0-beta; flash a firmware of "
      "version 2.0.1 or later");
}

TEST(ConnectionTest, RefusesAnotherDialectAndAnotherVersion) {
  Connection connection;
  connection.begin(Time{});
  connection.take(rosflight::Heartbeat{.mavlink_version = 3}, milliseconds(1));
  EXPECT_EQ(connection.state(), ConnectionState::kRefused);
  EXPECT_EQ(connection.refusal(),
            "the unit speaks version 3 of MAVLink's dialects, ROSflight 2.0 has 2; flash a firmware of "
            "version 2.0.1 or later");
  for (const char* text : {"v1.3", "v1.3.1-4-gabc", "3.0.0", "v20.1"}) {
    Connection other;
    other.begin(Time{});
    other.take(version(text), milliseconds(1));
    EXPECT_EQ(other.refusal(),
              std::string("the unit is of another version than ROSflight 2.0; it calls itself ") + text +
                  "; flash a firmware of version 2.0.1 or later");
  }
  for (const char* text : {"v2.0.0", "v2.0.0-3-gabc"}) {
    Connection first;
    first.begin(Time{});
    first.take(version(text), milliseconds(1));
    EXPECT_EQ(first.state(), ConnectionState::kRefused) << text;
    first.take(version("v2.0.1"), milliseconds(2));
    EXPECT_EQ(first.state(), ConnectionState::kHeard) << "it says otherwise now";
    EXPECT_EQ(first.refusal(), "");
  }
  for (const char* text : {"v2.0.1", "2.0.1", "v2.1.0-rc1", "e8cf6a0f", "1234567"}) {
    Connection ours;
    ours.begin(Time{});
    ours.take(version(text), milliseconds(1));
    EXPECT_EQ(ours.state(), ConnectionState::kHeard) << text;
  }
}

TEST(ConnectionTest, MeetsARefusedUnitThatHasBootedAsANewOne) {
  Connection connection;
  connection.begin(Time{});
  connection.take(rosflight::SmallImu{.time_boot_us = 5'000'000}, milliseconds(1));
  connection.take(rosflight::ParamValue{{1}, 251, 0, rosflight::field_of<16>("A"), 6}, milliseconds(2));
  ASSERT_EQ(connection.state(), ConnectionState::kRefused);
  connection.take(rosflight::SmallImu{.time_boot_us = 1000}, milliseconds(3));
  EXPECT_EQ(connection.state(), ConnectionState::kHeard) << "it may have another firmware now";
  EXPECT_EQ(connection.refusal(), "");
}

TEST(ConnectionTest, ForgivesReportsThatWereLostOnTheWay) {
  Connection connection;
  connection.begin(Time{});
  connection.take(rosflight::Heartbeat{}, Time{}, 5);
  connection.take(rosflight::RosflightStatus{.armed = 1}, Time{}, 5);
  EXPECT_TRUE(connection.heartbeat_alive(seconds(3)));
  EXPECT_FALSE(connection.heartbeat_alive(seconds(3) + milliseconds(1)));
  EXPECT_FALSE(connection.armed(milliseconds(501)));
  connection.take(rosflight::SmallImu{}, milliseconds(100), 6);  // a frame is missing
  EXPECT_TRUE(connection.armed(seconds(1)));
  EXPECT_FALSE(connection.armed(milliseconds(1001)));
  EXPECT_TRUE(connection.heartbeat_alive(seconds(10)));
  EXPECT_FALSE(connection.heartbeat_alive(milliseconds(10001)));
}

TEST(ConnectionTest, FallsSilentWhenNothingMoreComes) {
  Connection connection;
  connection.begin(Time{});
  connection.take(rosflight::SmallImu{.time_boot_us = 1000}, milliseconds(1));
  EXPECT_EQ(connection.state(), ConnectionState::kHeard);
  EXPECT_TRUE(connection.imu_alive(milliseconds(51)));
  EXPECT_FALSE(connection.imu_alive(milliseconds(52)));
  connection.advance(seconds(3), ignore);
  EXPECT_EQ(connection.state(), ConnectionState::kHeard);
  connection.advance(seconds(4), ignore);
  EXPECT_EQ(connection.state(), ConnectionState::kSilent);
}

TEST(ConnectionTest, TakesAStampThatNoClockCanHaveForABrokenOne) {
  Connection connection({.download = false});
  connection.begin(Time{});
  connection.take(rosflight::SmallImu{.time_boot_us = ~std::uint64_t{0}}, milliseconds(1));
  connection.take(rosflight::SmallImu{.time_boot_us = 90'000'000}, milliseconds(2));
  EXPECT_EQ(connection.reboots(), 1) << "the clock began anew";
  connection.take(rosflight::SmallImu{.time_boot_us = 90'002'500}, milliseconds(4));
  EXPECT_EQ(connection.reboots(), 1);
}

TEST(ConnectionTest, BelievesAnswersToItsOwnQuestionsOnly) {
  Connection connection;
  connection.begin(Time{});
  const Time now = milliseconds(100);
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  connection.take(rosflight::Timesync{.tc1 = kMost, .ts1 = 50'000'000}, now);
  connection.take(rosflight::Timesync{.tc1 = 1'000'000, .ts1 = -kMost}, now);
  connection.take(rosflight::Timesync{.tc1 = 1'000'000, .ts1 = kMost}, now);
  connection.take(rosflight::Timesync{.tc1 = 0, .ts1 = 50'000'000}, now);
  EXPECT_FALSE(connection.time_sync().valid);
  connection.take(rosflight::Timesync{.tc1 = 1'000'000, .ts1 = 50'000'000}, now);
  EXPECT_TRUE(connection.time_sync().valid);
}

TEST(ConnectionTest, KeepsAVersionThatItWasToldOnce) {
  Connection connection({.download = false});
  connection.begin(Time{});
  connection.take(version("v2.0.1"), milliseconds(1));
  connection.take(version(""), milliseconds(2));
  EXPECT_EQ(connection.version(), "v2.0.1");
  EXPECT_EQ(connection.state(), ConnectionState::kReady);
}

TEST(ConnectionTest, FindsEverythingOutAnewWhenTheUnitHasBooted) {
  Connection connection({.download = false});
  connection.begin(Time{});
  connection.take(rosflight::SmallImu{.time_boot_us = 90'000'000}, milliseconds(1));
  connection.take(version("v2.0.1"), milliseconds(2));
  EXPECT_EQ(connection.state(), ConnectionState::kReady);
  connection.take(rosflight::SmallImu{.time_boot_us = 89'990'000}, milliseconds(3));
  EXPECT_EQ(connection.reboots(), 0) << "a stamp out of order is no boot";
  connection.take(rosflight::SmallImu{.time_boot_us = 2500}, milliseconds(4));
  EXPECT_EQ(connection.reboots(), 1);
  EXPECT_EQ(connection.state(), ConnectionState::kHeard);
  EXPECT_EQ(connection.version(), "");
}

TEST(ConnectionTest, DoesNotAskForTheVersionOfAnArmedUnit) {
  Connection connection({.download = false});
  connection.begin(Time{});
  connection.take(rosflight::RosflightStatus{.armed = 1}, milliseconds(1));
  int asked = 0;
  for (int k = 0; k < 5000; ++k) {
    connection.advance(milliseconds(k), [&](const rosflight::Message& message) {
      asked += std::holds_alternative<rosflight::RosflightCmd>(message) ? 1 : 0;
    });
  }
  EXPECT_EQ(asked, 0);
}

TEST(ConnectionTest, SendsHeartbeatsAndTimeExchangesAtTheirRates) {
  Connection connection({.download = false});
  connection.begin(Time{});
  int heartbeats = 0;
  int exchanges = 0;
  for (int k = 0; k < 10'000; ++k) {
    connection.advance(milliseconds(k), [&](const rosflight::Message& message) {
      heartbeats += std::holds_alternative<rosflight::Heartbeat>(message) ? 1 : 0;
      exchanges += std::holds_alternative<rosflight::Timesync>(message) ? 1 : 0;
    });
  }
  EXPECT_EQ(heartbeats, 10);
  EXPECT_EQ(exchanges, 103) << "each 97.3 ms, seen with a millisecond each";
}

}  // namespace
}  // namespace ironbird::hil_bridge
