#include "hil_bridge/hil_fcu/can_motors.hpp"

#include <gtest/gtest.h>

#include "hil_bridge/can/esc_controller.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge {
namespace {

constexpr Time kMotorsPeriod = std::chrono::microseconds(2500);

/// A controller of CAN motors, and the bench that plays them.
class Loop {
 public:
  Loop() : controller_({}, bus_.attach(), Time{0}), motors_({}, rotor, bus_.attach(), Time{0}) {
    truth.battery_voltage = 24.0;
    controller_.set_armed(true);
  }

  simulator::RotorCommands run(double seconds) {
    simulator::RotorCommands commands;
    for (const Time end = now_ + Time(static_cast<std::int64_t>(seconds * 1e9)); now_ < end;) {
      now_ += kMotorsPeriod;
      controller_.command(throttles, now_);
      controller_.step(now_);
      bus_.advance(now_ + kMotorsPeriod);
      commands = motors_.step(truth, now_);
    }
    return commands;
  }
  can::EscController& controller() { return controller_; }
  CanMotors& motors() { return motors_; }
  transport::InProcessBus& bus() { return bus_; }
  Time now() const { return now_; }

  const simulator::RotorParams rotor;
  simulator::Truth truth;
  std::array<double, 4> throttles{0.1, 0.2, 0.3, 0.4};

 private:
  Time now_{0};
  transport::InProcessBus bus_;
  can::EscController controller_;
  CanMotors motors_;
};

TEST(CanMotorsTest, TurnsTheRotorsByTheCommandsOfTheBus) {
  Loop loop;
  const simulator::RotorCommands commands = loop.run(0.1);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(commands.throttle[k], loop.throttles[k], 1.0 / 8191.0);
  for (std::size_t k = 4; k < commands.throttle.size(); ++k) EXPECT_EQ(commands.throttle[k], 0.0);
}

TEST(CanMotorsTest, ReportsWhatTheSimulatedRotorDoes) {
  Loop loop;
  loop.throttles.fill(0.5);
  loop.truth.rotor_speed[1] = 300.0;
  loop.run(2.0);
  const can::EscStatus& status = loop.controller().motor(1).status;
  EXPECT_EQ(status.rpm, 2865);
  EXPECT_NEAR(status.voltage, 24.0, 0.01);
  const double throttle = loop.motors().status().motors[1].throttle;
  const double current = throttle * (throttle * 24.0 - loop.rotor.K_V * 300.0) / loop.rotor.resistance;
  EXPECT_NEAR(status.current, current, 0.05);
  EXPECT_EQ(loop.controller().motor(1).node, 21);
  EXPECT_TRUE(loop.controller().motor_ready(1, loop.now()));
}

TEST(CanMotorsTest, WarmsWithTheCurrentThroughTheMotorAndWarnsWhenHot) {
  Loop loop;
  loop.throttles.fill(0.5);
  loop.run(400.0);
  // Ten time constants: 12 V across the windings of a rotor that stands.
  const double through_motor = loop.motors().status().motors[0].throttle * 24.0 / loop.rotor.resistance;
  const double warm = 293.15 + 3.0 * 0.004 * through_motor * through_motor;
  EXPECT_NEAR(loop.motors().reading(0).temperature, warm, 0.5);
  EXPECT_EQ(loop.motors().reading(0).health, can::kHealthWarning);
  EXPECT_EQ(loop.controller().node(20).status.health, can::kHealthWarning);
}

TEST(CanMotorsTest, StopsTheRotorsWhenTheBusIsSilentAndTellsWhatTheBusIsAt) {
  Loop loop;
  loop.run(0.2);
  loop.bus().short_circuit(true);
  EXPECT_EQ(loop.run(0.3).throttle[3], 0.0);
  EXPECT_EQ(loop.motors().status().state, transport::BusState::kOff);
  bool off = false;
  while (const auto event = loop.motors().take_event())
    off = off || event->kind == transport::BusEventKind::kOff;
  EXPECT_TRUE(off);
}

}  // namespace
}  // namespace ironbird::hil_bridge
