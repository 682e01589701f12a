#include "scenarios/bench/felt_ground.hpp"

#include <gtest/gtest.h>

namespace ironbird::scenarios {
namespace {

using autopilot::FlightPhase;
using std::chrono::milliseconds;

class FeltGroundTest : public ::testing::Test {
 protected:
  void SetUp() override {
    signals_.flight.memory.launched = true;
    signals_.flight.phase = FlightPhase::kOffboard;
    signals_.estimate.p_NB_N.z() = -1.0;
    ASSERT_EQ(ground_.observe(signals_), "lifted_off");
    signals_.flight.phase = FlightPhase::kLanding;
    signals_.estimate.p_NB_N.z() = 0.0;
  }
  std::optional<std::string_view> feel(bool on_ground, milliseconds later) {
    signals_.flight.memory.on_ground = on_ground;
    signals_.estimate.stamp += later;
    return ground_.observe(signals_);
  }

  autopilot::Signals signals_;
  FeltGround ground_;
};

TEST_F(FeltGroundTest, HasLandedWhenTheGroundWasFeltForHalfASecond) {
  EXPECT_EQ(feel(true, milliseconds(100)), std::nullopt);
  EXPECT_EQ(feel(true, milliseconds(499)), std::nullopt);
  EXPECT_EQ(feel(true, milliseconds(1)), "landed");
}

TEST_F(FeltGroundTest, HasLandedWhenItIsDisarmedOnTheGround) {
  EXPECT_EQ(feel(true, milliseconds(100)), std::nullopt);
  // WHEN the pilot is quick, and the autopilot forgets the ground as it is disarmed
  signals_.flight.phase = FlightPhase::kDisarmed;
  EXPECT_EQ(feel(false, milliseconds(100)), "landed");
}

TEST_F(FeltGroundTest, HasNotLandedWhenItIsDisarmedInTheAir) {
  EXPECT_EQ(feel(true, milliseconds(100)), std::nullopt);
  EXPECT_EQ(feel(false, milliseconds(100)), std::nullopt);
  signals_.flight.phase = FlightPhase::kDisarmed;
  EXPECT_EQ(feel(false, milliseconds(100)), std::nullopt);
}

}  // namespace
}  // namespace ironbird::scenarios
