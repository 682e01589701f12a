#include "hil_bridge/transport/socket_can.hpp"
#include "hil_bridge/transport/test/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "hil_bridge/can/test/frame_text.hpp"
#include "hil_bridge/transport/can_link.hpp"
#include "hil_bridge/transport/test/foreign_tools.hpp"
#include "hil_bridge/transport/test/frame_bus_conformance.hpp"

// Runs where there are vcan0 and vcan1, with the right to set them up: under ci/with_vcan.

namespace ironbird::hil_bridge::transport {
namespace {

using can::frame_of;
using can::text_of;
using ::testing::HasSubstr;

/// Puts the kernel's error frames on the bus, as a controller's driver would.
void write_error(std::uint32_t classes, std::uint8_t controller = 0) {
  const int descriptor = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | classes;
  frame.can_dlc = CAN_ERR_DLC;
  frame.data[1] = controller;
  const bool bound = bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  EXPECT_TRUE(bound && write(descriptor, &frame, sizeof frame) == sizeof frame);
  close(descriptor);
}

class SocketRig final : public BusRig {
 public:
  explicit SocketRig(bool fd) {
    for (auto& end : ends_)
      end = std::make_unique<SocketCan>(SocketCanParams{.interface = "vcan0", .fd = fd});
  }
  FrameBus& end(int number) override { return *ends_[static_cast<std::size_t>(number)]; }
  bool wait() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return std::chrono::steady_clock::now() < until_;
  }
  void patience() override { until_ = std::chrono::steady_clock::now() + kPatience; }
  void drive_off() override { write_error(CAN_ERR_BUSOFF); }
  void restart() override { write_error(CAN_ERR_RESTARTED); }
  int receive_queue() const override { return 2000; }

 private:
  std::unique_ptr<SocketCan> ends_[3];
  std::chrono::steady_clock::time_point until_;
};

INSTANTIATE_TEST_SUITE_P(Socket, FrameBusConformance,
                         ::testing::Values(RigCase{"Can",
                                                   [](bool fd) { return std::make_unique<SocketRig>(fd); }}),
                         [](const auto& param) { return param.param.name; });

std::optional<ReceivedFrame> next(FrameBus& bus) {
  std::optional<ReceivedFrame> frame;
  comes_true([&] { return (frame = bus.receive()).has_value(); });
  return frame;
}

std::optional<BusEvent> next_event(FrameBus& bus) {
  std::optional<BusEvent> event;
  comes_true([&] {
    while (bus.receive()) {
    }
    return (event = bus.take_event()).has_value();
  });
  return event;
}

Time monotonic() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + Time(now.tv_nsec);
}

TEST(SocketCanTest, IsHeardByCandump) {
  SocketCan bus({.interface = "vcan0", .fd = true});
  const std::vector<std::string> frames = {"0804060A#E80F407B82E80FC7", "1801948A#C1", "123#",
                                           "7FF#0102030405060708", "1E48D100#01A0A1A2A3A4A5C0"};
  Candump candump("vcan0", static_cast<int>(frames.size()) + 1);
  for (const std::string& frame : frames) EXPECT_TRUE(bus.send(frame_of(frame)));
  EXPECT_TRUE(bus.send(frame_of("0804060A##27407A03DC174078000000C7")));
  std::vector<std::string> expected = frames;
  expected.emplace_back("0804060A##127407A03DC174078000000C7");
  std::vector<std::string> heard = candump.frames();
  // The digit behind ## says bit-rate switch, and in newer kernels also that the frame is one of CAN FD.
  if (const std::size_t digit = heard.back().find("##5"); digit != std::string::npos)
    heard.back()[digit + 2] = '1';
  EXPECT_EQ(heard, expected);
}

TEST(SocketCanTest, HearsCansend) {
  SocketCan bus({.interface = "vcan0", .fd = true});
  struct Case {
    const char* sent;
    const char* heard;
    bool remote;
  };
  for (const Case& one : {Case{"18010A94#60403C0000000081", "18010A94#60403C0000000081", false},
                          Case{"5A1#11.22.33", "5A1#112233", false}, Case{"00000123#R", "00000123#", true},
                          Case{"0804060A##1AABBCCDD", "0804060A##AABBCCDD", false}}) {
    run(std::string("cansend vcan0 ") + one.sent);
    const std::optional<ReceivedFrame> arrived = next(bus);
    ASSERT_TRUE(arrived.has_value()) << one.sent;
    EXPECT_EQ(text_of(arrived->frame), one.heard);
    EXPECT_EQ(arrived->frame.remote, one.remote);
  }
}

TEST(SocketCanTest, HearsTheSameAsCandumpOfWhatCangenSays) {
  constexpr int kFrames = 300;
  SocketCan bus({.interface = "vcan0", .receive_buffer = 1 << 20});
  Candump candump("vcan0", kFrames);
  run("cangen vcan0 -e -g 0 -p 100 -I r -L r -D r -n " + std::to_string(kFrames));
  const std::vector<std::string> heard = candump.frames();
  std::vector<std::string> ours;
  while (const std::optional<ReceivedFrame> arrived = bus.receive()) ours.push_back(text_of(arrived->frame));
  EXPECT_EQ(ours, heard);
  EXPECT_EQ(ours.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(bus.counters().lost, 0U);
}

TEST(SocketCanTest, StampsWithTheMonotonicClockSinceItsEpoch) {
  const Time epoch = monotonic() - std::chrono::seconds(5);
  SocketCan receiver({.interface = "vcan0"}, epoch);
  SocketCan sender({.interface = "vcan0"});
  const Time before = monotonic();
  ASSERT_TRUE(sender.send(frame_of("123#00")));
  const Time after = monotonic();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const std::optional<ReceivedFrame> arrived = next(receiver);
  ASSERT_TRUE(arrived.has_value());
  // The two clocks are read one after the other; the sleep is far longer than that takes.
  constexpr Time kReading = std::chrono::milliseconds(100);
  EXPECT_GE(arrived->stamp, before - epoch - kReading);
  EXPECT_LE(arrived->stamp, after - epoch + kReading);
}

TEST(SocketCanTest, TellsTheStatesOfTheController) {
  SocketCan bus({.interface = "vcan0"});
  struct Case {
    std::uint32_t classes;
    std::uint8_t controller;
    BusEventKind kind;
    BusState state;
  };
  for (const Case& one :
       {Case{CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, BusEventKind::kWarning, BusState::kWarning},
        Case{CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, BusEventKind::kPassive, BusState::kPassive},
        Case{CAN_ERR_ACK, 0, BusEventKind::kNoAcknowledge, BusState::kPassive},
        Case{CAN_ERR_BUSOFF, 0, BusEventKind::kOff, BusState::kOff},
        Case{CAN_ERR_RESTARTED, 0, BusEventKind::kRestarted, BusState::kActive}}) {
    write_error(one.classes, one.controller);
    const std::optional<BusEvent> event = next_event(bus);
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(event->kind, one.kind) << name_of(event->kind);
    EXPECT_EQ(bus.state(), one.state);
  }
}

TEST(SocketCanTest, SurvivesThatTheInterfaceIsSwitchedOff) {
  SocketCan bus({.interface = "vcan1"});
  SocketCan other({.interface = "vcan1"});
  run("ip link set vcan1 down");
  EXPECT_EQ(next_event(bus)->kind, BusEventKind::kDown);
  EXPECT_EQ(bus.state(), BusState::kDown);
  EXPECT_FALSE(bus.send(frame_of("123#00")));
  run("ip link set vcan1 up");
  EXPECT_EQ(next_event(bus)->kind, BusEventKind::kUp);
  EXPECT_EQ(next_event(other)->kind, BusEventKind::kDown);
  EXPECT_EQ(next_event(other)->kind, BusEventKind::kUp);
  EXPECT_TRUE(other.send(frame_of("123#0102")));
  EXPECT_EQ(text_of(next(bus)->frame), "123#0102");
}

std::size_t descriptors() {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& one : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

TEST(SocketCanTest, TakesUpAnInterfaceThatWasUnpluggedWithItsFilters) {
  SocketCan bus({.interface = "vcan1"});
  bus.set_filters(std::array{FrameFilter{0x100, 0x1FFFFFFF, true}});
  const std::size_t before = descriptors();
  for (int round = 0; round < 5; ++round) {
    run("ip link del vcan1");
    EXPECT_EQ(next_event(bus)->kind, BusEventKind::kGone);
    EXPECT_FALSE(bus.send(frame_of("123#00")));
    run("ip link add vcan1 type vcan && ip link set vcan1 mtu 72 up");
    EXPECT_EQ(next_event(bus)->kind, BusEventKind::kUp);
    SocketCan other({.interface = "vcan1"});
    other.send(frame_of("00000200#01"));
    other.send(frame_of("00000100#02"));
    EXPECT_EQ(text_of(next(bus)->frame), "00000100#02");
  }
  EXPECT_EQ(descriptors(), before);
}

TEST(SocketCanTest, RefusesAnInterfaceThatIsNotThereAndTellsWhichAre) {
  EXPECT_THAT(refusal({.interface = "can7"}),
              HasSubstr("CAN interface can7: not found; there are: vcan0, vcan1"));
  EXPECT_THAT(refusal({.interface = ""}), HasSubstr("not found"));
  EXPECT_THAT(refusal({.interface = "a_name_that_is_far_too_long_for_one"}), HasSubstr("not found"));
}

TEST(SocketCanTest, RefusesAnInterfaceThatIsNoneForCan) {
  EXPECT_THAT(refusal({.interface = "lo"}), HasSubstr("CAN interface lo: carries no CAN"));
}

TEST(SocketCanTest, RefusesAnInterfaceThatIsDownWithTheRemedy) {
  run("ip link set vcan1 down");
  const std::string said = refusal({.interface = "vcan1"});
  EXPECT_EQ(said, "CAN interface vcan1: is down. Switch it on: ip link set vcan1 up");
  run(said.substr(said.rfind(": ") + 2));
  EXPECT_EQ(refusal({.interface = "vcan1"}), "taken");
}

TEST(SocketCanTest, RefusesCanFdWhereOnlyClassicFramesFitWithTheRemedy) {
  run("ip link set vcan1 down && ip link set vcan1 mtu 16 up");
  const std::string said = refusal({.interface = "vcan1", .fd = true});
  EXPECT_THAT(said, HasSubstr("does not carry CAN FD"));
  EXPECT_EQ(refusal({.interface = "vcan1"}), "taken");
  run(said.substr(said.rfind(": ") + 2));
  EXPECT_EQ(refusal({.interface = "vcan1", .fd = true}), "taken");
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
