#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/rosflight/messages.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

inline constexpr int kOutputs = 14;          ///< physical output pins; the mixer can drive the first ten
inline constexpr int kRcChannels = 24;       ///< channels of one frame
inline constexpr float kGravity = 9.80665F;  ///< m/s^2, the firmware's constant
inline constexpr float kSeaLevelDensity = 1.225F;  ///< kg/m^3, used until the barometer speaks

/// Three numbers along the body axes front, right, down.
struct Triple {
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("x", self.x, "SI", "front");
    visit("y", self.y, "SI", "right");
    visit("z", self.z, "SI", "down");
  }
};

/// Inertial sample as the chip delivers it, or after correction.
struct ImuInput {
  std::uint64_t stamp_us = 0;
  Triple acceleration;
  Triple angular_velocity;
  float temperature = 300.15F;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp_us", self.stamp_us, "us", "board clock when it was taken");
    visit("acceleration", self.acceleration, "m/s^2", "specific force");
    visit("angular_velocity", self.angular_velocity, "rad/s", "angular velocity");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

/// Pressure sample: absolute or differential.
struct PressureInput {
  float pressure = 0.0F;
  float temperature = 288.15F;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pressure", self.pressure, "Pa", "absolute or differential");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

/// Battery sample as the converter delivers it.
struct BatteryInput {
  float voltage = 0.0F;
  float current = 0.0F;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("voltage", self.voltage, "V", "before BATT_VOLT_MULT");
    visit("current", self.current, "A", "before BATT_CURR_MULT");
  }
};

/// One frame of the pilot's receiver.
struct RcFrame {
  std::array<float, kRcChannels> channels{};
  bool frame_lost = false;
  bool failsafe = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("channels", self.channels, "1", "normalised, 0..1");
    visit("frame_lost", self.frame_lost, "1", "the receiver says that it missed a frame");
    visit("failsafe", self.failsafe, "1", "the receiver says that it lost the transmitter");
  }
};

/// What the firmware sees of its hardware in one pass of its loop: the clock, at most one new sample of each
/// sensor, at most one RC frame and the messages that arrived; and what it gives back: outputs and messages.
///
/// Whoever calls `Firmware::pass` fills it and clears the samples afterwards.
struct Board {
  std::uint64_t clock_us = 0;  ///< since boot
  std::optional<ImuInput> imu;
  std::optional<Triple> mag;  ///< T
  std::optional<PressureInput> baro;
  std::optional<PressureInput> differential_pressure;
  std::optional<float> range;                    ///< m
  std::optional<rosflight::RosflightGnss> gnss;  ///< complete, passed through
  std::optional<BatteryInput> battery;
  std::optional<RcFrame> rc;
  std::span<const rosflight::Message> received;  ///< in order of arrival
  std::int16_t sensor_errors = 0;                ///< read errors counted by the board
  std::int16_t loop_time_us = 0;                 ///< reported duration of the control part of a pass, us

  std::array<float, kOutputs> outputs{};  ///< 0..1, held until written again
  std::vector<Arrival>* sent = nullptr;   ///< where messages go; null: nobody listens, none are built
  Time sent_arrival{};                    ///< arrival time given to the messages sent in this pass

  /// Forgets what was new in the last pass.
  void clear_inputs() {
    imu.reset();
    mag.reset();
    baro.reset();
    differential_pressure.reset();
    range.reset();
    gnss.reset();
    battery.reset();
    rc.reset();
    received = {};
  }
};

}  // namespace ironbird::hil_bridge::virtual_fcu
