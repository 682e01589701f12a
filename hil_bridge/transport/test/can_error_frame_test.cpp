#include "hil_bridge/transport/can_error_frame.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ironbird::hil_bridge::transport {
namespace {

struct ErrorCase {
  const char* name;
  std::uint32_t classes;
  std::array<std::uint8_t, 8> data;
  std::vector<BusEventKind> events;
};

class CanErrorFrameTest : public ::testing::TestWithParam<ErrorCase> {};

TEST_P(CanErrorFrameTest, IsTakenApart) {
  CanFrame error;
  error.error = true;
  error.identifier = GetParam().classes;
  error.size = 8;
  std::copy(GetParam().data.begin(), GetParam().data.end(), error.data.begin());
  std::vector<BusEventKind> kinds;
  const ErrorEvents events = events_of(error, Time(42));
  for (const BusEvent& event : events.view()) {
    kinds.push_back(event.kind);
    EXPECT_EQ(event.stamp, Time(42));
  }
  EXPECT_EQ(kinds, GetParam().events);
}

using enum BusEventKind;
// Numbers of the kernel's interface: classes in the identifier, the controller's state in byte 1, place in
// byte 3.
INSTANTIATE_TEST_SUITE_P(
    Kernel, CanErrorFrameTest,
    ::testing::Values(
        ErrorCase{"Nothing", 0, {}, {}}, ErrorCase{"SendTimeout", 0x1, {}, {kSendTimeout}},
        ErrorCase{"LostArbitrationIsNoEvent", 0x2, {5}, {}}, ErrorCase{"Overrun", 0x4, {0, 0x01}, {kLost}},
        ErrorCase{"Warning", 0x4, {0, 0x04}, {kWarning}},
        ErrorCase{"WarningOfBothKindsIsOne", 0x4, {0, 0x0C}, {kWarning}},
        ErrorCase{"Passive", 0x4, {0, 0x20}, {kPassive}}, ErrorCase{"Active", 0x4, {0, 0x40}, {kActive}},
        ErrorCase{"StateBytesWithoutTheirClassDoNotCount", 0x8, {0, 0x20}, {kBusError}},
        ErrorCase{"BusError", 0x88, {0, 0, 0x04, 0x0A}, {kBusError}},
        ErrorCase{"NoAcknowledge", 0x20, {}, {kNoAcknowledge}},
        ErrorCase{"NoAcknowledgeByItsPlace", 0x88, {0, 0, 0, 0x19}, {kNoAcknowledge}},
        ErrorCase{"Off", 0x40, {}, {kOff}}, ErrorCase{"Restarted", 0x100, {}, {kRestarted}},
        ErrorCase{"ErrorAndItsConsequence", 0x8C, {0, 0x20}, {kBusError, kPassive}},
        ErrorCase{"Everything",
                  0x1FF,
                  {0, 0xFF},
                  {kRestarted, kSendTimeout, kNoAcknowledge, kLost, kActive, kWarning, kPassive, kOff}}),
    [](const auto& param) { return param.param.name; });

TEST(CanErrorFrameCounterTest, HandsOnTheErrorCounters) {
  CanFrame error;
  error.identifier = 0x204;
  error.data = {0, 0x20, 0, 0, 0, 0, 130, 7};
  const ErrorEvents events = events_of(error, Time(0));
  ASSERT_EQ(events.count, 1U);
  EXPECT_EQ(events.items[0].send_errors, 130);
  EXPECT_EQ(events.items[0].receive_errors, 7);
}

TEST(CanErrorFrameStateTest, FollowsTheEventsThatSayAState) {
  EXPECT_EQ(state_after(kOff), BusState::kOff);
  EXPECT_EQ(state_after(kPassive), BusState::kPassive);
  EXPECT_EQ(state_after(kWarning), BusState::kWarning);
  EXPECT_EQ(state_after(kRestarted), BusState::kActive);
  EXPECT_EQ(state_after(kGone), BusState::kDown);
  EXPECT_EQ(state_after(kBusError), std::nullopt);
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
