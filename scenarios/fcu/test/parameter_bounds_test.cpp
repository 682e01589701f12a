#include "scenarios/fcu/parameter_bounds.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::scenarios {
namespace {

using hil_bridge::kIntegerParameter;
using hil_bridge::kRealParameter;

std::string about(const char* name, float value) {
  return complaint_about_value({name, kRealParameter, std::bit_cast<std::uint32_t>(value)});
}
std::string about(const char* name, int value) {
  return complaint_about_value({name, kIntegerParameter, std::bit_cast<std::uint32_t>(value)});
}

TEST(ParameterBoundsTest, SaysWhatAValueMustBe) {
  EXPECT_EQ(about("FAILSAFE_THR", 7.5F), "must be between 0 and 1");
  EXPECT_EQ(about("RC_MAX_THR", -40.0F), "must be between 0 and 1");
  EXPECT_EQ(about("NUM_MOTORS", 99999), "must be between 1 and 10");
  EXPECT_EQ(about("OFFBOARD_TIMEOUT", -1), "must be between 0 and 100000 ms");
  EXPECT_EQ(about("SYS_ID", 256), "must be between 1 and 255");
}

TEST(ParameterBoundsTest, RefusesWhatIsNotFiniteAlsoWhereThereIsNoBound) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(about("PID_ROLL_RATE_P", infinity), "must be finite");
  EXPECT_EQ(about("PID_ROLL_RATE_P", -infinity), "must be finite");
  EXPECT_EQ(about("MOTOR_IDLE_THR", std::numeric_limits<float>::quiet_NaN()), "must be finite");
  EXPECT_EQ(about("PID_ROLL_RATE_P", std::numeric_limits<float>::max()), "");
}

TEST(ParameterBoundsTest, AllowsTheBoundsThemselves) {
  EXPECT_EQ(about("RC_MAX_THR", 1.0F), "");
  EXPECT_EQ(about("MOTOR_RESISTANCE", 0.0001F), "") << "the float is less than the bound";
  EXPECT_EQ(about("RC_ARM_CHN", -1), "");
}

TEST(ParameterBoundsTest, AllowsEveryDefaultOfTheFirmware) {
  for (const auto& info : hil_bridge::virtual_fcu::kParameterTable) {
    const std::string name(hil_bridge::rosflight::text_of(info.name));
    EXPECT_EQ(complaint_about_value({name, static_cast<std::uint8_t>(info.type), info.default_bits}), "")
        << name;
  }
}

TEST(ParameterBoundsTest, JudgesNoNameAndNoTypeThatTheFirmwareDoesNotHave) {
  EXPECT_EQ(about("NO_SUCH", 7.5F), "");
  EXPECT_EQ(about("NUM_MOTORS", 99999.0F), "");
}

}  // namespace
}  // namespace ironbird::scenarios
