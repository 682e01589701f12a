#pragma once

#include <bit>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hil_bridge/serial_fcu/serial_fcu.hpp"
#include "hil_bridge/transport/link_fault.hpp"
#include "hil_bridge/transport/stream_pair.hpp"
#include "hil_bridge/virtual_fcu/firmware_host.hpp"
#include "hil_bridge/virtual_fcu/served_fcu.hpp"

// A unit that lies still on the desk, served over a line with faults in both directions, in simulated time.

namespace ironbird::hil_bridge::test {

/// The firmware on a board that does not move.
class DeskUnit final : public Fcu {
 public:
  explicit DeskUnit(const VirtualFcuConfig& config = {}) : host_(config) {}
  void advance(Time now) override {
    simulator::Readings readings;
    readings.imu = simulator::ImuReading{};
    readings.imu->taken = now;
    readings.imu->f_B = f_B_;
    readings.imu->w_NB_B = w_NB_B_;
    if (pressure_) {
      readings.baro = simulator::BaroReading{};
      readings.baro->taken = now;
      readings.baro->pressure = *pressure_;
    }
    host_.tick(readings, now);
  }
  /// What the IMU measures from now on.
  void feel(const simulator::Vector3& f_B, const simulator::Vector3& w_NB_B) {
    f_B_ = f_B;
    w_NB_B_ = w_NB_B;
  }
  /// What the barometer measures from now on; until then there is none.
  void press(double pressure) { pressure_ = pressure; }
  void receive(std::vector<Arrival>& out) override { host_.receive(out); }
  void send(const rosflight::Message& message) override { host_.send(message); }
  FirmwareHost& host() { return host_; }
  const FirmwareHost& host() const { return host_; }

 private:
  FirmwareHost host_;
  simulator::Vector3 f_B_{0.0, 0.0, -9.80665};
  simulator::Vector3 w_NB_B_ = simulator::Vector3::Zero();
  std::optional<double> pressure_;
};

/// Loses this share of the frames of each direction, on a line of 921600 Bd.
inline transport::LinkFaultConfig losing(double share) {
  constexpr double kByteRate = 92160.0;
  transport::DirectionFaults faults;
  faults.drop = share;
  faults.byte_rate = kByteRate;
  return {faults, {}};
}

inline rosflight::ParamSet setting(std::string_view name, std::uint32_t bits, std::uint8_t type) {
  return {.param_value = {bits},
          .target_system = 1,
          .param_id = rosflight::field_of<16>(name),
          .param_type = type};
}
inline rosflight::ParamSet setting(std::string_view name, float value) {
  return setting(name, std::bit_cast<std::uint32_t>(value), kRealParameter);
}
inline rosflight::ParamSet setting(std::string_view name, int value) {
  return setting(name, std::bit_cast<std::uint32_t>(value), kIntegerParameter);
}

/// Both ends, ticking together.
class DeskLink {
 public:
  static constexpr Time kTick = std::chrono::microseconds(2500);
  /// Bench time at which the unit's clock was zero.
  static constexpr Time kBooted = std::chrono::milliseconds(7300);

  explicit DeskLink(double loss = 0.0, std::uint64_t seed = 1, const ConnectionConfig& connection = {},
                    const VirtualFcuConfig& unit = {})
      : unit_(unit),
        there_(pair_.far(), losing(loss), seed, &rosflight::piece_length),
        here_(pair_.near(), losing(loss), seed + 1000, &rosflight::piece_length),
        served_(unit_, there_),
        fcu_(here_, connection, &gate_) {}

  void tick() {
    now_ += kTick;
    there_.advance(now_);
    here_.advance(now_);
    fcu_.advance(now_);
    inbox_.clear();
    fcu_.receive(inbox_);
    here_.advance(now_);
    there_.advance(now_);
    served_.take();
    unit_.advance(now_ - kBooted);
    served_.give();
  }
  /// Ticks until `holds`. @return the time it took, or the limit
  template <class Holds>
  Time until(Time limit, Holds&& holds) {
    const Time began = now_;
    while (now_ - began < limit && !holds()) tick();
    return now_ - began;
  }

  Time now() const { return now_; }
  DeskUnit& unit() { return unit_; }
  SerialFcu& fcu() { return fcu_; }
  transport::StreamPair& pair() { return pair_; }
  const std::vector<Arrival>& inbox() const { return inbox_; }
  const virtual_fcu::Firmware& firmware() { return unit_.host().firmware(); }

 private:
  Time now_ = kBooted;
  transport::StreamPair pair_;
  DeskUnit unit_;
  transport::LinkFault there_;
  transport::LinkFault here_;
  ServedFcu served_;
  SimulatedUnitGate gate_;
  SerialFcu fcu_;
  std::vector<Arrival> inbox_;
};

}  // namespace ironbird::hil_bridge::test
