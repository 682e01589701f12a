#include "hil_bridge/serial_fcu/parameter_client.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <tuple>

#include "hil_bridge/serial_fcu/test/served_unit.hpp"
#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::DeskLink;
using virtual_fcu::kParameterCount;
using virtual_fcu::kParameterTable;

std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

/// How many of the unit's own values are known here, bit for bit.
int exact(DeskLink& link) {
  const auto known = link.fcu().connection().parameters().known();
  int count = 0;
  for (std::size_t k = 0; k < known.size() && k < kParameterTable.size(); ++k) {
    const bool same = known[k].name == rosflight::text_of(kParameterTable[k].name) &&
                      known[k].type == static_cast<std::uint8_t>(kParameterTable[k].type) &&
                      known[k].bits == link.firmware().parameters().bits({static_cast<std::uint16_t>(k)});
    count += same ? 1 : 0;
  }
  return count;
}

bool complete(DeskLink& link) {
  return link.fcu().connection().parameters().progress().complete;
}

/// Share of frames lost in each direction, and the time within which all parameters are known.
class LossyLine : public testing::TestWithParam<std::tuple<double, Time>> {};

TEST_P(LossyLine, HasAllParametersExactInTime) {
  const auto [loss, limit] = GetParam();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DeskLink link(loss, seed);
    const Time took = link.until(limit, [&] { return complete(link); });
    ASSERT_LT(took, limit) << "seed " << seed;
    EXPECT_EQ(exact(link), kParameterCount);
  }
}

TEST_P(LossyLine, SetsParametersAndKnowsThatTheyAreSet) {
  const auto [loss, limit] = GetParam();
  DeskLink link(loss, 7);
  link.until(limit, [&] { return complete(link); });
  ParameterClient& client = link.fcu().connection().parameters();
  for (int k = 0; k < 40; ++k) {
    const ParameterRecord wanted{"PRI_MIXER_" + std::to_string(k % 10) + "_" + std::to_string(k / 10), 9,
                                 bits_of(0.01F * static_cast<float>(k + 1))};
    ASSERT_EQ(client.set(wanted), "");
  }
  link.until(seconds(60), [&] { return client.idle(); });
  EXPECT_TRUE(client.failures().empty());
  EXPECT_EQ(exact(link), kParameterCount);
  EXPECT_EQ(client.find("PRI_MIXER_3_2")->bits, bits_of(0.01F * 24.0F));
  EXPECT_TRUE(client.unsaved());
  client.write_to_flash();
  link.until(seconds(20), [&] { return client.idle(); });
  EXPECT_EQ(client.write_outcome(), ParameterOutcome::kDone);
  EXPECT_FALSE(client.unsaved());
}

INSTANTIATE_TEST_SUITE_P(
    Losses, LossyLine,
    testing::Values(std::tuple{0.0, Time(seconds(2))}, std::tuple{0.05, Time(seconds(3))},
                    std::tuple{0.2, Time(seconds(5))}, std::tuple{0.5, Time(seconds(12))}),
    [](const auto& line) {
      return "of" + std::to_string(static_cast<int>(100.0 * std::get<0>(line.param))) + "Percent";
    });

TEST(ParameterClientTest, CarriesAnIntegerWhoseBitsAreANan) {
  DeskLink link;
  link.until(seconds(2), [&] { return complete(link); });
  ParameterClient& client = link.fcu().connection().parameters();
  EXPECT_EQ(client.set({"RC_ARM_CHN", 6, bits_of(2.0F)}), "");
  link.until(seconds(1), [&] { return client.idle(); });
  EXPECT_EQ(client.set({"RC_ARM_CHN", 6, 0xFFFFFFFFU}), "");
  link.until(seconds(1), [&] { return client.idle(); });
  EXPECT_EQ(link.firmware().parameters().integer(virtual_fcu::find_parameter("RC_ARM_CHN")), -1);
  EXPECT_EQ(client.find("RC_ARM_CHN")->bits, 0xFFFFFFFFU);
}

TEST(ParameterClientTest, NeedsNoAnswerForAValueThatIsThereAlready) {
  DeskLink link;
  link.until(seconds(2), [&] { return complete(link); });
  ParameterClient& client = link.fcu().connection().parameters();
  EXPECT_EQ(client.set(*client.find("NUM_MOTORS")), "");
  EXPECT_TRUE(client.idle());
}

TEST(ParameterClientTest, RefusesNamesAndTypesThatTheUnitDoesNotHave) {
  DeskLink link;
  link.until(seconds(2), [&] { return complete(link); });
  ParameterClient& client = link.fcu().connection().parameters();
  EXPECT_EQ(client.set({"NO_SUCH", 6, 1}), "NO_SUCH: the unit has no such parameter");
  EXPECT_EQ(client.set({"NUM_MOTORS", 9, 1}), "NUM_MOTORS: is a whole number in the unit");
}

TEST(ParameterClientTest, LearnsWhatTheUnitChangesByItself) {
  DeskLink link;
  link.until(seconds(2), [&] { return complete(link); });
  // WHEN a canned mixer is chosen the firmware rewrites the elements of the mixer
  ParameterClient& client = link.fcu().connection().parameters();
  ASSERT_EQ(client.set({"PRIMARY_MIXER", 6, 2}), "");
  link.until(seconds(3), [&] { return client.idle(); });
  link.until(milliseconds(500), [] { return false; });
  EXPECT_EQ(exact(link), kParameterCount);
}

TEST(ParameterClientTest, GivesUpASetThatTheUnitDoesNotKeep) {
  // GIVEN a unit that says an old value whatever is set
  ParameterClient client;
  Time now{};
  const auto answer = [&] {
    client.take(rosflight::ParamValue{{1}, 1, 0, rosflight::field_of<16>("A"), 6}, now);
  };
  client.start_download(now);
  answer();
  ASSERT_EQ(client.set({"A", 6, 2}), "");
  for (int k = 0; k < 20'000 && !client.idle(); ++k) {
    now += milliseconds(2);
    client.advance(now, [&](const rosflight::Message&) { answer(); });
  }
  ASSERT_EQ(client.failures().size(), 1U);
  EXPECT_EQ(client.failures()[0].outcome, ParameterOutcome::kDifferent);
}

TEST(ParameterClientTest, SaysThatASetGotNoAnswer) {
  ParameterClient client;
  Time now{};
  client.start_download(now);
  client.take(rosflight::ParamValue{{1}, 1, 0, rosflight::field_of<16>("A"), 6}, now);
  ASSERT_EQ(client.set({"A", 6, 2}), "");
  client.write_to_flash();
  for (int k = 0; k < 20'000 && !client.idle(); ++k) {
    now += milliseconds(2);
    client.advance(now, [](const rosflight::Message&) {});
  }
  ASSERT_EQ(client.failures().size(), 1U);
  EXPECT_EQ(client.failures()[0].outcome, ParameterOutcome::kNoAnswer);
  EXPECT_EQ(client.write_outcome(), ParameterOutcome::kNoAnswer);
}

TEST(ParameterClientTest, TellsARefusedWriteToFlashFromNoAnswer) {
  ParameterClient client;
  client.write_to_flash();
  client.advance(Time{}, [](const rosflight::Message&) {});
  client.take(rosflight::RosflightCmdAck{.command = rosflight::kWriteParameters, .success = 0});
  EXPECT_EQ(client.write_outcome(), ParameterOutcome::kRefused);
  EXPECT_TRUE(client.idle());
}

TEST(ParameterClientTest, PaysNoAttentionToValuesThatCannotBe) {
  ParameterClient client;
  client.take(rosflight::ParamValue{{1}, 5, 5, rosflight::field_of<16>("A"), 6}, Time{});
  client.take(rosflight::ParamValue{{1}, 60000, 5, rosflight::field_of<16>("A"), 6}, Time{});
  client.take(rosflight::ParamValue{{1}, 5, 2, rosflight::field_of<16>("A"), 7}, Time{});
  EXPECT_EQ(client.progress().count, 0);
}

}  // namespace
}  // namespace ironbird::hil_bridge
