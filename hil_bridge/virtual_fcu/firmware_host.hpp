#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/virtual_fcu/firmware.hpp"
#include "hil_bridge/virtual_fcu/rc_pilot.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/rotor_commands.hpp"

namespace ironbird::hil_bridge {

/// How the virtual FCU is set up.
struct VirtualFcuConfig {
  static constexpr Time kLeastTick = std::chrono::microseconds(100);
  static constexpr Time kGreatestTick = std::chrono::milliseconds(20);
  /// Of the period of the pilot's frames, which has to be whole ticks.
  static constexpr double kRcTolerance = 1e-9;

  std::vector<virtual_fcu::ParameterOverride> parameters;
  Time tick = std::chrono::microseconds(2500);
  double rc_rate = 100.0;
  bool rc_every_pass = false;
  bool two_passes = true;
  Time uplink_latency{};
  Time downlink_latency{};
  double pwm_resolution = 0.0;
  bool calibrate_imu_at_start = true;
  bool undefined_when_inverted = false;
  bool on_desk = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("parameters", self.parameters, "", "firmware parameters that are not at their default");
    visit("tick", self.tick, "ns", "period of the IMU and of the control loop, whole microseconds",
          static_cast<double>(kLeastTick.count()), static_cast<double>(kGreatestTick.count()));
    visit("rc_rate", self.rc_rate, "Hz",
          "frames of the pilot's receiver; the period is a whole number of ticks", 0.1, 1000.0);
    visit("rc_every_pass", self.rc_every_pass, "1",
          "a new RC frame in every pass, as the reference simulator");
    visit("two_passes", self.two_passes, "1",
          "messages and RC are taken just before the IMU pass; otherwise in it, and act one tick later");
    visit("uplink_latency", self.uplink_latency, "ns", "companion to FCU, a whole number of ticks", 0.0, 1e9);
    visit("downlink_latency", self.downlink_latency, "ns", "FCU to companion, a whole number of ticks", 0.0,
          1e9);
    visit("pwm_resolution", self.pwm_resolution, "1", "outputs are rounded down to a multiple of it; 0: not",
          0.0, 0.1);
    visit("calibrate_imu_at_start", self.calibrate_imu_at_start, "1",
          "orders an IMU calibration with the first tick: 2.5 s at rest");
    visit("undefined_when_inverted", self.undefined_when_inverted, "1",
          "reproduces the filter's division by zero for an accelerometer exactly along +Bz");
    visit("on_desk", self.on_desk, "1",
          "the virtual unit's own vehicle stands still whatever its outputs are");
  }
};

/// Runs the firmware on a simulated board: clock, sensor samples, the pilot's frames, the link's delays.
///
/// In one tick the loop passes twice: first the passes since the last IMU sample, as one, take messages and
/// RC; then the IMU pass controls. So a message sent after tick k acts in tick k + 1, as on a board whose
/// loop spins thousands of times between samples.
class FirmwareHost {
 public:
  /// @throws std::invalid_argument naming key, value and bound
  explicit FirmwareHost(const VirtualFcuConfig& config);

  /// One tick. @param now  a multiple of the tick, later than the last
  void tick(const simulator::Readings& readings, Time now);

  /// What the speed controllers are told now: the first outputs, one per rotor.
  simulator::RotorCommands commands() const;

  /// Appends what has arrived at the companion by now.
  void receive(std::vector<Arrival>& out);
  /// Takes a message that leaves the companion now.
  void send(const rosflight::Message& message);

  Time now() const { return now_; }
  const virtual_fcu::Firmware& firmware() const { return firmware_; }
  const virtual_fcu::Board& board() const { return board_; }
  RcPilot& pilot() { return pilot_; }

 private:
  void take_messages();
  void drop_messages();
  void take_rc();
  void take_readings(const simulator::Readings& readings);

  VirtualFcuConfig config_;
  Time rc_period_{};
  virtual_fcu::Firmware firmware_;
  virtual_fcu::Board board_;
  RcPilot pilot_;
  Time now_{};
  std::vector<rosflight::Message> uplink_;
  std::vector<Time> uplink_arrivals_;
  std::size_t delivered_ = 0;
  std::vector<Arrival> downlink_;
};

}  // namespace ironbird::hil_bridge
