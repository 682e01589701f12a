#pragma once

#include <cstdint>
#include <string>

#include "scenarios/replay/px4_flight.hpp"
#include "scenarios/replay/test/ulog_by_hand.hpp"

// A PX4 log made by hand, of a second or less.

namespace ironbird::scenarios::test {

inline constexpr std::uint64_t kBoot = 5'000'000;  ///< us, of the first sample of the IMU

/// An IMU at 250 Hz, to which a test adds topics.
class LogByHand {
 public:
  LogByHand() {
    log_.format(
        "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t "
        "accelerometer_timestamp_relative;float[3] accelerometer_m_s2;");
    log_.subscribe(0, 1, "sensor_combined");
  }
  LogByHand& imu(std::uint64_t at, std::int32_t relative = 0, float rate = 0.1F) {
    log_.record(1, kBoot + at, rate, 0.2F, 0.3F, std::uint32_t{4000}, relative, 0.5F, -0.25F, -9.75F);
    return *this;
  }
  LogByHand& second() {
    for (std::uint64_t k = 0; k <= 250; ++k) imu(4000 * k);
    return *this;
  }
  UlogByHand& log() { return log_; }
  /// Records of topic `id`, described as in a log: name and fields.
  LogByHand& topic(std::uint16_t id, const std::string& described) {
    log_.format(described).subscribe(0, id, described.substr(0, described.find(':')));
    return *this;
  }
  Px4Flight read(const Px4Choice& choice = {}) const {
    return read_px4_flight(log_.read(), "by_hand.ulg", choice);
  }

 private:
  UlogByHand log_;
};

}  // namespace ironbird::scenarios::test
