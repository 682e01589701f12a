// PX4's own estimate in logs made by hand: what of it is believed, and what is said of it.

#include "scenarios/replay/px4_estimate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/config/degrees.hpp"
#include "scenarios/replay/test/log_by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using std::chrono::milliseconds;
using test::kBoot;
using test::LogByHand;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

TEST(Px4EstimateTest, ReadsTheRecordedEstimateWhereItWasBelieved) {
  LogByHand log;
  log.second();
  log.log()
      .format("vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;")
      .subscribe(0, 20, "vehicle_attitude");
  log.log().record(20, kBoot + 101'000, kBoot + 100'000, 1.0F, 0.0F, 0.0F, 0.0F);
  log.log().record(20, kBoot + 201'000, kBoot + 200'000, std::nanf(""), 0.0F, 0.0F, 0.0F);
  log.log().format(
      "vehicle_local_position:uint64_t timestamp;double ref_lat;double ref_lon;float x;float y;float z;float "
      "vx;float vy;float vz;float ref_alt;bool xy_valid;bool z_valid;bool v_xy_valid;bool v_z_valid;");
  log.log().subscribe(0, 21, "vehicle_local_position");
  const auto position = [&log](std::uint64_t at, std::uint8_t valid) {
    log.log().record(21, kBoot + at, 47.3, 8.5, 1.0F, 2.0F, -3.0F, 0.1F, 0.2F, 0.3F, 430.0F, valid,
                     std::uint8_t{1}, valid, std::uint8_t{1});
  };
  position(100'000, 0);
  position(300'000, 1);
  const Px4Flight px4 = log.read();
  ASSERT_EQ(px4.flight.estimates.size(), 1U);
  const RecordedEstimate& recorded = px4.flight.estimates[0];
  EXPECT_EQ(recorded.name, "PX4");
  ASSERT_EQ(recorded.attitudes.size(), 1U);
  EXPECT_EQ(recorded.attitudes[0].stamp, milliseconds(100)) << "of the sample, not of its publication";
  ASSERT_EQ(recorded.positions.size(), 2U);
  EXPECT_FALSE(recorded.positions[0].position_known);
  EXPECT_FALSE(recorded.positions[0].velocity_known);
  EXPECT_TRUE(recorded.positions[0].height_known);
  EXPECT_TRUE(recorded.positions[1].position_known);
  EXPECT_NEAR(recorded.origin.latitude, 47.3 / kDegreesPerRadian, 1e-12);
}

TEST(Px4EstimateTest, ComparesOnTheEarthWhenPx4MovesItsOrigin) {
  LogByHand log;
  log.second().topic(21,
                     "vehicle_local_position:uint64_t timestamp;double ref_lat;double ref_lon;float x;float "
                     "y;float z;float ref_alt;uint8_t xy_reset_counter;");
  constexpr double kNorth = 100.0 / 111'320.0;  // deg
  log.log().record(21, kBoot + 100'000, 47.3, 8.5, 10.0F, 0.0F, -3.0F, 430.0F, std::uint8_t{0});
  log.log().record(21, kBoot + 200'000, 47.3 + kNorth, 8.5, -90.0F, 0.0F, -3.0F, 430.0F, std::uint8_t{1});
  const Px4Flight px4 = log.read();
  const auto& positions = px4.flight.estimates.at(0).positions;
  ASSERT_EQ(positions.size(), 2U);
  EXPECT_NEAR(positions[1].p_NB_N.x(), positions[0].p_NB_N.x(), 0.1);
  EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("1 times PX4 moved the origin")));
  EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("1 times PX4 stepped its position")));
}

/// Of steps at these times after the first sample of the IMU, s, by so much, rad.
std::vector<std::string> remarks_on_steps(const std::vector<std::pair<double, float>>& steps) {
  LogByHand log;
  log.second().topic(21,
                     "vehicle_local_position:uint64_t timestamp;float x;float y;float z;float "
                     "delta_heading;uint8_t heading_reset_counter;");
  std::uint8_t counter = 3;
  const auto record = [&](double when, float change) {
    const auto us = static_cast<std::int64_t>(kBoot) + std::llround(1e6 * when);
    log.log().record(21, static_cast<std::uint64_t>(us), 0.0F, 0.0F, 0.0F, change, counter);
  };
  record(-0.2, 0.0F);
  ++counter;  // before the first sample: nobody's
  record(0.001, 0.0F);
  for (const auto& [when, change] : steps) {
    ++counter;
    record(when, change);
    record(when + 0.01, change);
  }
  return log.read().flight.remarks;
}

TEST(Px4EstimateTest, TellsWhenPx4SteppedItsHeadingAndByHowMuch) {
  EXPECT_THAT(remarks_on_steps({}), Not(Contains(HasSubstr("stepped its heading"))));
  EXPECT_THAT(remarks_on_steps({{0.2, -0.388F}, {0.6, 0.0446F}}),
              Contains("PX4 stepped its heading by -22.2 deg at 0.2 s, by 2.6 deg at 0.6 s"));
}

TEST(Px4EstimateTest, TellsNoSizeOfAStepThatCannotBe) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(remarks_on_steps({{0.2, kNan}, {0.4, 3e38F}, {0.6, -0.0004F}}),
              Contains("PX4 stepped its heading at 0.2 s, at 0.4 s, by 0.0 deg at 0.6 s"));
}

TEST(Px4EstimateTest, ListsNoMoreStepsThanAnybodyReads) {
  const auto remarks = remarks_on_steps(
      {{0.1, 0.0F}, {0.2, 0.0F}, {0.3, 0.0F}, {0.4, 0.0F}, {0.5, 0.0F}, {0.6, 0.0F}, {0.7, 0.0F}});
  EXPECT_THAT(remarks, Contains(EndsWith("by 0.0 deg at 0.5 s and 2 times more")));
}

}  // namespace
}  // namespace ironbird::scenarios
