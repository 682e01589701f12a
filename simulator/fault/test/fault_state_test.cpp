#include "simulator/fault/fault_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>

namespace ironbird::simulator {
namespace {

using ::testing::HasSubstr;

TEST(FaultStateTest, IsHarmlessWithoutFaults) {
  const FaultState state = combine({});
  for (const double efficiency : state.rotor_efficiency) EXPECT_EQ(efficiency, 1.0);
  EXPECT_FALSE(state.imu.dropout || state.mag.dropout || state.baro.dropout || state.gnss.dropout);
  EXPECT_EQ(state.payload, 0.0);
}

TEST(FaultStateTest, AddsUpFaultsOfOneKind) {
  const std::array<Fault, 8> faults = {{{.kind = FaultKind::kRotorEfficiency, .index = 2, .magnitude = 0.5},
                                        {.kind = FaultKind::kRotorEfficiency, .index = 2, .magnitude = 0.8},
                                        {.kind = FaultKind::kRotorLoss, .index = 1},
                                        {.kind = FaultKind::kWind, .vector = Vector3(1.0, 0.0, 0.0)},
                                        {.kind = FaultKind::kWind, .vector = Vector3(2.0, 3.0, 0.0)},
                                        {.kind = FaultKind::kPayload, .magnitude = 0.2},
                                        {.kind = FaultKind::kPayload, .magnitude = 0.3},
                                        {.kind = FaultKind::kGnssDropout}}};
  const FaultState state = combine(faults);
  EXPECT_DOUBLE_EQ(state.rotor_efficiency[2], 0.4);
  EXPECT_EQ(state.rotor_efficiency[1], 0.0);
  EXPECT_EQ(state.rotor_efficiency[0], 1.0);
  EXPECT_EQ(state.wind_N, Vector3(3.0, 3.0, 0.0));
  EXPECT_EQ(state.payload, 0.5);
  EXPECT_TRUE(state.gnss.dropout);
  EXPECT_FALSE(state.gnss.non_finite);
}

TEST(FaultStateTest, KnowsEveryKind) {
  // Every kind but the battery's, which is an event, changes the state.
  for (const auto& [kind, name] : enumerators(FaultKind{})) {
    const std::array<Fault, 1> faults = {{{kind, 3, 0.25, Vector3(1.0, 2.0, 3.0)}}};
    const FaultState state = combine(faults);
    const bool changed = state.rotor_efficiency[3] != 1.0 || state.imu.dropout || state.mag.dropout ||
                         state.baro.dropout || state.gnss.dropout || state.imu.non_finite ||
                         state.mag.non_finite || state.baro.non_finite || state.gnss.non_finite ||
                         !state.accelerometer_bias.isZero() || !state.gyro_bias.isZero() ||
                         !state.mag_bias.isZero() || state.baro_bias != 0.0 || !state.gnss_jump_N.isZero() ||
                         !state.wind_N.isZero() || state.payload != 0.0;
    EXPECT_EQ(changed, kind != FaultKind::kBatteryCharge) << name;
  }
}

struct RefusalCase {
  const char* name;
  Fault fault;
  const char* message;
};

class FaultCheckTest : public ::testing::TestWithParam<RefusalCase> {};

TEST_P(FaultCheckTest, RefusesWhatTheVehicleCannotHave) {
  try {
    check(GetParam().fault, 4);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultCheckTest,
    ::testing::Values(
        RefusalCase{
            "Rotor", {.kind = FaultKind::kRotorLoss, .index = 4}, "rotor_loss: index = 4, must be 0..3"},
        RefusalCase{"Share",
                    {.kind = FaultKind::kRotorEfficiency, .index = 0, .magnitude = 1.5},
                    "rotor_efficiency: magnitude = 1.5, must be 0..1"},
        RefusalCase{"Battery", {.kind = FaultKind::kBatteryCharge, .magnitude = -0.1}, "must be 0..1"},
        RefusalCase{"Payload", {.kind = FaultKind::kPayload, .magnitude = -1.0}, "must be >= 0"},
        RefusalCase{
            "NotFinite",
            {.kind = FaultKind::kWind, .vector = Vector3(0.0, std::numeric_limits<double>::infinity(), 0.0)},
            "wind: vector = inf"}),
    [](const auto& sample) { return sample.param.name; });

TEST(FaultAcceptanceTest, AcceptsAnIndexThatItsKindDoesNotUse) {
  EXPECT_NO_THROW(check({.kind = FaultKind::kGnssDropout, .index = 99}, 4));
}

}  // namespace
}  // namespace ironbird::simulator
