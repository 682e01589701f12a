#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hil_bridge/transport/can_link.hpp"
#include "hil_bridge/transport/socket_can.hpp"
#include "hil_bridge/transport/test/refusal.hpp"

// What a machine without CAN says. With CAN in its kernel it says something else, as clearly.

namespace ironbird::hil_bridge::transport {
namespace {

TEST(SocketCanRefusalTest, SaysInOneLineWhatIsMissingAndWhatToDo) {
  const std::string said = refusal({.interface = "nocan0"});
  EXPECT_THAT(said, ::testing::StartsWith("CAN interface nocan0: "));
  EXPECT_THAT(
      said, ::testing::AnyOf(::testing::HasSubstr("modprobe can_raw"), ::testing::HasSubstr("not found; ")));
  EXPECT_EQ(said.find('\n'), std::string::npos);
}

TEST(SocketCanRefusalTest, NamesAParameterOutOfBounds) {
  EXPECT_EQ(refusal({.bit_rate = -1}), "socket_can.bit_rate = -1 bit/s, must be between 0 and 1e+06");
}

TEST(CanLinkTest, KnowsThatALoopbackCarriesNoCan) {
  const std::optional<CanLink> link = read_can_link("lo");
  ASSERT_TRUE(link.has_value());
  EXPECT_FALSE(link->can);
  EXPECT_EQ(link->bit_rate, 0U);
  EXPECT_FALSE(read_can_link("nocan0").has_value());
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
