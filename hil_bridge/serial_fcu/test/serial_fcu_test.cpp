#include "hil_bridge/serial_fcu/serial_fcu.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include "hil_bridge/serial_fcu/test/served_unit.hpp"
#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "hil_bridge/transport/serial_port.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::DeskLink;
using test::DeskUnit;

TEST(SerialFcuTest, TurnsTheStampsOfTheUnitIntoBenchTime) {
  DeskLink link;
  link.until(seconds(3), [] { return false; });
  Time stamp{};
  link.until(seconds(1), [&] {
    for (const Arrival& arrival : link.inbox()) {
      if (const auto* imu = std::get_if<rosflight::SmallImu>(&arrival.message)) {
        stamp = microseconds(static_cast<std::int64_t>(imu->time_boot_us));
      }
    }
    return stamp != Time{};
  });
  // The stamp is a tick old on arrival; an exchange that cannot know which of its two ways took a tick, half
  // a tick wrong.
  EXPECT_NEAR(static_cast<double>((link.now() - stamp).count()), 2.5e6, 1.3e6);
}

TEST(SerialFcuTest, KnowsHowMuchTheLineLoses) {
  DeskLink link(0.2);
  link.until(seconds(10), [] { return false; });
  const LinkHealth health = link.fcu().health(link.now());
  EXPECT_NEAR(health.loss, 0.2, 0.04);
  EXPECT_NEAR(health.frame_rate, 0.8 * (400.0 * 2.0 + 50.0 + 100.0 + 10.0 + 10.0 + 1.0), 60.0);
  EXPECT_EQ(health.corrupted, 0U);
  EXPECT_LT(health.age, milliseconds(20));
}

TEST(SerialFcuTest, DropsWholeFramesWhenTheLineTakesNoMore) {
  transport::StreamPair pair(100);
  SimulatedUnitGate gate;
  SerialFcu fcu(pair.near(), {.synchronise = false, .download = false}, &gate);
  fcu.advance(Time{});
  for (int k = 0; k < 1000; ++k) fcu.send(rosflight::OffboardControl{.u = {static_cast<float>(k)}});
  EXPECT_GT(fcu.health(Time{}).unsent, 700U);
  rosflight::StreamDecoder decoder;
  std::vector<rosflight::Frame> frames;
  for (int k = 0; k < 1000; ++k) {
    std::array<std::uint8_t, 100> bytes{};
    const std::size_t count = pair.far().read(bytes);
    decoder.push(std::span(bytes).first(count),
                 [&](const rosflight::Frame& frame) { frames.push_back(frame); });
    fcu.flush();
  }
  EXPECT_EQ(decoder.counts().skipped_bytes, 0U);
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].sequence, static_cast<std::uint8_t>(frames[k - 1].sequence + 1));
  }
}

// They end up on a terminal, in a log and in JSON.
TEST(SerialFcuTest, LetsNoBytesThroughThatAreNoText) {
  transport::StreamPair pair(4096);
  SerialFcu fcu(pair.near(), {.synchronise = false});
  fcu.advance(Time{});
  std::uint8_t sequence = 0;
  const auto say = [&](const rosflight::Message& message) {
    const auto frame = rosflight::encode_frame(message, sequence++, {1, 1});
    pair.far().write(std::span(frame.bytes).first(frame.size));
  };
  say(rosflight::RosflightVersion{rosflight::field_of<50>("v2.0.1\xFF")});
  say(rosflight::Statustext{.text = rosflight::field_of<50>("\033[2Jhello")});
  say(rosflight::ParamValue{
      .param_count = 333, .param_id = rosflight::field_of<16>("A\nB"), .param_type = kIntegerParameter});
  fcu.advance(Time{1});
  EXPECT_EQ(fcu.connection().version(), "v2.0.1?");
  std::vector<Arrival> arrivals;
  fcu.receive(arrivals);
  ASSERT_EQ(arrivals.size(), 3U);
  const auto said = std::get<rosflight::Statustext>(arrivals[1].message);
  EXPECT_EQ(rosflight::text_of(said.text), "?[2Jhello");
  const auto known = fcu.connection().parameters().known();
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known.front().name, "A?B");
}

TEST(SerialFcuTest, SendsNothingThatActsWithoutAGate) {
  transport::StreamPair pair;
  SerialFcu fcu(pair.near(), {.synchronise = false, .download = false});
  fcu.advance(Time{});
  fcu.send(rosflight::OffboardControl{});
  fcu.send(rosflight::RosflightAuxCmd{});
  fcu.send(rosflight::ParamSet{});
  fcu.send(rosflight::ExternalAttitude{});
  for (std::uint8_t command = 0; command < 10; ++command) fcu.send(rosflight::RosflightCmd{command});
  rosflight::StreamDecoder decoder;
  std::array<std::uint8_t, 4096> bytes{};
  const std::size_t count = pair.far().read(bytes);
  decoder.push(std::span(bytes).first(count), [&](const rosflight::Frame& frame) {
    const auto* order = std::get_if<rosflight::RosflightCmd>(&frame.message);
    EXPECT_TRUE(std::holds_alternative<rosflight::Heartbeat>(frame.message) ||
                (order != nullptr && order->command == 10));
  });
  EXPECT_EQ(decoder.counts().frames, 2U);
}

TEST(SerialFcuTest, AsksToWriteToFlashAsTheUsualCompanionDoes) {
  transport::StreamPair pair;
  SimulatedUnitGate gate;
  SerialFcu fcu(pair.near(), {.synchronise = false, .download = false}, &gate);
  fcu.advance(Time{});
  fcu.send(rosflight::RosflightCmd{.command = 6});
  rosflight::StreamDecoder decoder;
  std::array<std::uint8_t, 4096> bytes{};
  const std::size_t count = pair.far().read(bytes);
  int component = -1;
  decoder.push(std::span(bytes).first(count), [&](const rosflight::Frame& frame) {
    const auto* order = std::get_if<rosflight::RosflightCmd>(&frame.message);
    if (order != nullptr && order->command == 6) component = frame.sender.component;
  });
  EXPECT_EQ(component, 1);
}

TEST(SerialFcuTest, FollowsAUnitWhoseSystemNumberIsSet) {
  DeskLink link(0.2);
  const auto ready = [&] { return link.fcu().connection().state() == ConnectionState::kReady; };
  link.until(seconds(10), ready);
  ParameterClient& client = link.fcu().connection().parameters();
  ASSERT_EQ(client.set({"SYS_ID", kIntegerParameter, 9}), "");
  link.until(seconds(5), [&] { return client.idle(); });
  EXPECT_TRUE(client.failures().empty());
  // WHEN more is asked of the unit THEN it is asked under its new number
  ASSERT_EQ(client.set({"NUM_MOTORS", kIntegerParameter, 6}), "");
  link.until(seconds(5), [&] { return client.idle(); });
  EXPECT_EQ(link.firmware().parameters().integer(virtual_fcu::find_parameter("NUM_MOTORS")), 6);
  // WHEN the line has been cut THEN the unit is met again under it
  link.pair().hang_up();
  link.pair().far().reopen();
  link.tick();
  ASSERT_FALSE(ready());
  link.until(seconds(10), ready);
  EXPECT_TRUE(ready());
  EXPECT_EQ(client.find("SYS_ID")->bits, 9U);
}

TEST(SerialFcuTest, FollowsOnlyFramesThatCarryTheUnitsOwnNumber) {
  transport::StreamPair pair;
  SerialFcu fcu(pair.near());
  fcu.advance(Time{});
  const auto hear = [&](const rosflight::Message& message, std::uint8_t system) {
    const rosflight::FrameBytes frame = rosflight::encode_frame(message, 0, {system, 250});
    pair.far().write(std::span(frame.bytes).first(frame.size));
    fcu.advance(Time{});
    return fcu.connection().parameters().system();
  };
  EXPECT_EQ(hear(rosflight::Statustext{}, 77), 1) << "the low byte of a clock";
  EXPECT_EQ(hear(rosflight::RosflightCmdAck{.command = 99}, 50), 1) << "the number of whoever asked";
  EXPECT_EQ(hear(rosflight::Heartbeat{}, 2), 2);
  EXPECT_EQ(hear(rosflight::SmallImu{}, 3), 3);
}

TEST(SerialFcuTest, StartsWithoutALineAndIsReadyWhenItComes) {
  DeskLink link;
  link.pair().hang_up();
  // Both ends of a pair come up when they are tried again: nobody tries the far one.
  link.until(milliseconds(500), [] { return false; });
  EXPECT_EQ(link.fcu().connection().state(), ConnectionState::kSilent);
  link.pair().far().reopen();
  link.until(seconds(2), [&] { return link.fcu().connection().state() == ConnectionState::kReady; });
  EXPECT_EQ(link.fcu().connection().state(), ConnectionState::kReady);
}

std::ptrdiff_t open_files() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return std::distance(begin(files), end(files));
}

TEST(SerialFcuTest, SurvivesAThousandHangUpsAtAnyByte) {
  const std::string path = testing::TempDir() + "ironbird_hang_ups";
  transport::PseudoTerminal terminal(path);
  transport::SerialPort port({path, 921600});
  SerialFcu fcu(port);
  std::mt19937 random(8);
  Time now{};
  const auto tick = [&] { fcu.advance(now += microseconds(2500)); };
  std::ptrdiff_t files = 0;
  for (int run = 0; run < 1000; ++run) {
    // GIVEN a frame of which some bytes have arrived
    const auto frame = rosflight::encode_frame(rosflight::SmallImu{.time_boot_us = 1}, 0, {1, 250});
    tick();
    terminal.write(std::span(frame.bytes).first(random() % (frame.size + 1)));
    if (random() % 2U == 0U) tick();
    // WHEN the plug is pulled, put in again, and the unit goes on
    terminal.hang_up();
    tick();
    ASSERT_TRUE(terminal.reopen());
    const Time back = now;
    std::vector<Arrival> heard;
    fcu.receive(heard);
    heard.clear();
    while (heard.empty() && now - back < milliseconds(200)) {
      terminal.write(std::span(frame.bytes).first(frame.size));
      std::this_thread::sleep_for(microseconds(20));
      tick();
      fcu.receive(heard);
    }
    // THEN the first frame is there within a tenth of a second, and no file is left open
    ASSERT_FALSE(heard.empty()) << "run " << run;
    ASSERT_LE(now - back, milliseconds(100)) << "run " << run;
    if (run == 0) files = open_files();
    ASSERT_EQ(open_files(), files) << "run " << run;
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge
