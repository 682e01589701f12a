#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/tty.h>
#include <net/if.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <memory>
#include <mutex>
#include <thread>

#include "hil_bridge/can/test/frame_text.hpp"
#include "hil_bridge/transport/can_link.hpp"
#include "hil_bridge/transport/socket_can.hpp"
#include "hil_bridge/transport/test/foreign_tools.hpp"
#include "hil_bridge/transport/test/refusal.hpp"

// Real drivers: two emulated PCI controllers on one bus, and a serial adapter that is played here, at the
// other end of a pseudo-terminal. Runs under ci/with_vcan --controllers.

namespace ironbird::hil_bridge::transport {
namespace {

using can::frame_of;
using can::text_of;
using ::testing::HasSubstr;

std::optional<ReceivedFrame> next(FrameBus& bus) {
  std::optional<ReceivedFrame> frame;
  comes_true([&] { return (frame = bus.receive()).has_value(); });
  return frame;
}

BusEvent next_event(FrameBus& bus) {
  std::optional<BusEvent> event;
  EXPECT_TRUE(comes_true([&] {
    while (bus.receive()) {
    }
    return (event = bus.take_event()).has_value();
  }));
  return event.value_or(BusEvent{});
}

TEST(CanControllerTest, CarriesFramesFromOneControllerToTheOther) {
  SocketCan sender({.interface = "can0", .bit_rate = 500000});
  SocketCan receiver({.interface = "can1", .bit_rate = 500000});
  for (const char* frame : {"0804060A#E80F407B82E80FC7", "123#", "1FFFFFFF#0102030405060708"}) {
    ASSERT_TRUE(sender.send(frame_of(frame)));
    const std::optional<ReceivedFrame> arrived = next(receiver);
    ASSERT_TRUE(arrived.has_value());
    EXPECT_EQ(text_of(arrived->frame), frame);
  }
  EXPECT_EQ(sender.state(), BusState::kActive);
}

TEST(CanControllerTest, LosesNothingOfABurst) {
  constexpr int kFrames = 500;
  SocketCan sender({.interface = "can0"});
  SocketCan receiver({.interface = "can1", .receive_buffer = 1 << 20});
  for (int k = 0; k < kFrames; ++k) {
    CanFrame frame = frame_of("0804060A#0000000000000000");
    frame.data[0] = static_cast<std::uint8_t>(k);
    frame.data[1] = static_cast<std::uint8_t>(k >> 8);
    ASSERT_TRUE(comes_true([&] { return sender.send(frame); }));
  }
  for (int k = 0; k < kFrames; ++k) {
    const std::optional<ReceivedFrame> arrived = next(receiver);
    ASSERT_TRUE(arrived.has_value()) << k;
    ASSERT_EQ(arrived->frame.data[0] | arrived->frame.data[1] << 8, k);
  }
}

TEST(CanControllerTest, RefusesAnotherBitRateThanAskedForWithTheRemedy) {
  const std::string said = refusal({.interface = "can0", .bit_rate = 1000000});
  EXPECT_THAT(said, HasSubstr("runs at 500000 bit/s, asked for are 1000000"));
  run(said.substr(said.rfind("Set it: ") + 8));
  EXPECT_EQ(read_can_link("can0")->bit_rate, 1000000U);
  EXPECT_EQ(refusal({.interface = "can0", .bit_rate = 1000000}), "taken");
  run("ip link set can0 down; ip link set can0 up type can bitrate 500000");
}

TEST(CanControllerTest, RefusesCanFdOnAClassicController) {
  EXPECT_THAT(refusal({.interface = "can0", .fd = true}), HasSubstr("does not carry CAN FD"));
}

TEST(CanControllerTest, RefusesAControllerThatIsDownWithTheRemedy) {
  run("ip link set can1 down");
  const std::string said = refusal({.interface = "can1", .bit_rate = 250000});
  EXPECT_EQ(said, "CAN interface can1: is down. Switch it on: ip link set can1 up type can bitrate 250000");
  run(said.substr(said.rfind(": ") + 2));
  EXPECT_EQ(refusal({.interface = "can1", .bit_rate = 250000}), "taken");
  run("ip link set can1 down; ip link set can1 up type can bitrate 500000");
}

/// A serial CAN adapter: letters in, letters out. The kernel's driver takes its line and makes an interface
/// of it.
class SerialAdapterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    termios raw{};
    cfmakeraw(&raw);
    ASSERT_EQ(openpty(&adapter_, &line_, nullptr, &raw, nullptr), 0);
    reader_ = std::jthread([this](std::stop_token stop) { listen(stop); });
    const int driver = N_SLCAN;
    ASSERT_EQ(ioctl(line_, TIOCSETD, &driver), 0) << "the kernel has no slcan";
    char name[IFNAMSIZ] = {};
    ASSERT_EQ(ioctl(line_, SIOCGIFNAME, name), 0);
    name_ = name;
    run("ip link set " + name_ + " up type can bitrate 500000");
    bus_ = std::make_unique<SocketCan>(SocketCanParams{.interface = name_, .bit_rate = 500000});
  }
  void TearDown() override {
    bus_.reset();
    pull_out();
    if (line_ >= 0) close(line_);
  }

  void say(const std::string& letters) {
    ASSERT_EQ(write(adapter_, letters.data(), letters.size()), static_cast<ssize_t>(letters.size()));
  }
  /// What the driver told the adapter. @return whether it told this
  bool hears(const std::string& letters) {
    return comes_true([&] {
      const std::scoped_lock lock(mutex_);
      return heard_.find(letters) != std::string::npos;
    });
  }
  void pull_out() {
    reader_ = {};
    if (adapter_ >= 0) close(adapter_);
    adapter_ = -1;
  }
  /// The driver waits until its letters are taken: somebody has to do it all the time.
  void listen(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd line = {adapter_, POLLIN, 0};
      char piece[256];
      const ssize_t size = poll(&line, 1, 10) > 0 ? read(adapter_, piece, sizeof piece) : 0;
      const std::scoped_lock lock(mutex_);
      if (size > 0) heard_.append(piece, static_cast<std::size_t>(size));
    }
  }

  int adapter_ = -1;
  int line_ = -1;
  std::string name_;
  std::mutex mutex_;
  std::string heard_;
  std::unique_ptr<SocketCan> bus_;
  std::jthread reader_;
};

TEST_F(SerialAdapterTest, CarriesFramesBothWaysAtTheBitRateThatWasSet) {
  EXPECT_TRUE(hears("S6\r")) << "500 kbit/s";
  ASSERT_TRUE(bus_->send(frame_of("0804060A#E80F407B82E80FC7")));
  EXPECT_TRUE(hears("T0804060A8E80F407B82E80FC7\r"));
  say("T18010A94860403C0000000081\rt12320102\r");
  EXPECT_EQ(text_of(next(*bus_)->frame), "18010A94#60403C0000000081");
  EXPECT_EQ(text_of(next(*bus_)->frame), "123#0102");
}

TEST_F(SerialAdapterTest, TellsThatNobodyAcknowledges) {
  say("e1a\r");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kNoAcknowledge);
  EXPECT_EQ(bus_->state(), BusState::kActive);
}

TEST_F(SerialAdapterTest, TellsWarningPassiveAndOffWithTheErrorCounters) {
  say("sw000096\r");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kWarning);
  EXPECT_EQ(bus_->state(), BusState::kWarning);
  say("sp003130\r");
  const BusEvent passive = next_event(*bus_);
  EXPECT_EQ(passive.kind, BusEventKind::kPassive);
  EXPECT_EQ(passive.send_errors, 130);
  EXPECT_EQ(passive.receive_errors, 3);
  EXPECT_EQ(bus_->state(), BusState::kPassive);
  EXPECT_EQ(read_can_link(name_)->state, BusState::kPassive);
  say("sb000255\r");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kOff);
  EXPECT_EQ(bus_->state(), BusState::kOff);
}

TEST_F(SerialAdapterTest, TellsThatItIsActiveAgainWithoutHavingBeenOff) {
  say("sp000130\r");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kPassive);
  say("sa000010\r");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kActive);
  EXPECT_EQ(bus_->state(), BusState::kActive);
}

TEST_F(SerialAdapterTest, IsAskedForItsStateWhenItIsOpenedLate) {
  say("sp000130\r");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kPassive);
  SocketCan late({.interface = name_});
  EXPECT_EQ(late.state(), BusState::kPassive);
}

TEST_F(SerialAdapterTest, RecoversFromBusOffWhenItIsSwitchedOffAndOn) {
  say("sb000255\r");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kOff);
  run("ip link set " + name_ + " down");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kDown);
  EXPECT_EQ(bus_->state(), BusState::kDown);
  run("ip link set " + name_ + " up");
  EXPECT_EQ(next_event(*bus_).kind, BusEventKind::kUp);
  EXPECT_EQ(bus_->state(), BusState::kActive);
  say("t12320102\r");
  EXPECT_EQ(text_of(next(*bus_)->frame), "123#0102");
}

TEST_F(SerialAdapterTest, TellsWhenTheAdapterIsPulledOut) {
  pull_out();
  BusEventKind last = BusEventKind::kActive;
  EXPECT_TRUE(comes_true([&] {
    while (bus_->receive()) {
    }
    while (const auto event = bus_->take_event()) last = event->kind;
    return last == BusEventKind::kGone;
  }));
  EXPECT_EQ(bus_->state(), BusState::kDown);
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
