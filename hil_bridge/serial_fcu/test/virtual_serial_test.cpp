#include "hil_bridge/serial_fcu/virtual_serial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "hil_bridge/serial_fcu/test/served_unit.hpp"

namespace ironbird::hil_bridge {
namespace {

using test::DeskUnit;

constexpr Time kTick = std::chrono::microseconds(2500);

/// What the unit says in a run in which it is armed, commanded, asked and set, each at its time.
std::vector<rosflight::FrameBytes> said(Fcu& fcu, DeskUnit& unit) {
  std::vector<rosflight::FrameBytes> frames;
  std::mt19937 random(2);
  Time now{};
  for (int k = 0; k < 4000; ++k) {
    now += kTick;
    if (k == 600) unit.host().pilot().arm(true);
    const float any = 1e-9F * static_cast<float>(random());
    if (k > 100) fcu.send(rosflight::OffboardControl{.u = {0, 0, -any, 0.01F * any}, .ignore = 0, .mode = 0});
    fcu.advance(now);
    std::vector<Arrival> arrivals;
    fcu.receive(arrivals);
    for (const Arrival& arrival : arrivals) {
      // The line has talk of its own, and it takes up time in which nothing else is said.
      const bool talk = std::holds_alternative<rosflight::ParamValue>(arrival.message) ||
                        std::holds_alternative<rosflight::RosflightVersion>(arrival.message) ||
                        std::holds_alternative<rosflight::RosflightCmdAck>(arrival.message) ||
                        std::holds_alternative<rosflight::Statustext>(arrival.message);
      if (!talk) frames.push_back(rosflight::encode_frame(arrival.message, 0, {}));
    }
  }
  return frames;
}

TEST(VirtualSerialFcuTest, SaysAndDoesTheSameAsTheUnitWithoutALine) {
  VirtualFcuConfig config;
  config.calibrate_imu_at_start = false;
  DeskUnit direct_unit(config);
  const auto direct = said(direct_unit, direct_unit);
  DeskUnit served_unit(config);
  SimulatedUnitGate gate;
  VirtualSerialFcu line(served_unit, {}, &gate);
  const auto served = said(line, served_unit);
  ASSERT_EQ(direct.size(), served.size());
  for (std::size_t k = 0; k < direct.size(); ++k) {
    ASSERT_EQ(direct[k].size, served[k].size) << k;
    ASSERT_TRUE(std::equal(direct[k].bytes.begin(),
                           direct[k].bytes.begin() + static_cast<std::ptrdiff_t>(direct[k].size),
                           served[k].bytes.begin()))
        << k;
  }
  EXPECT_EQ(direct_unit.host().board().outputs, served_unit.host().board().outputs);
  EXPECT_EQ(line.serial().connection().state(), ConnectionState::kReady);
  EXPECT_EQ(line.serial().health(4000 * kTick).lost, 0U);
}

}  // namespace
}  // namespace ironbird::hil_bridge
