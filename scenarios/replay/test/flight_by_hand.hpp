#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "scenarios/replay/test/ulog_by_hand.hpp"

// A PX4 log of a short flight, made by hand, and what can be wrong with such a log.

namespace ironbird::scenarios::test {

/// What is logged, and how well.
struct FlightByHand {
  double seconds = 8.0;
  bool imu = true;
  bool gnss = true;
  bool mag = true;
  bool estimate = true;
  bool jump = false;              ///< one fix in the middle is a hundred metres off
  bool clock_steps_back = false;  ///< in the middle
  bool no_numbers = false;        ///< every fourth value of every slow sensor and of the estimate
  std::uint8_t vehicle_type = 1;  ///< 1: rotary wing, 2: fixed wing
  std::uint8_t hil_state = 0;
  float hitl = 0.0F;  ///< parameter SYS_HITL
  std::string_view board = "PX4_FMU_V6C";

  static constexpr std::uint64_t kBoot = 5'000'000;  ///< us, of the first sample of the IMU
  static constexpr double kTakeOff = 3.0;            ///< s: it is armed at 1 s, returns from 5 s on
  static constexpr double kReturn = 5.0;

  UlogByHand log() const {
    UlogByHand log;
    log.keyed('I', "char[3] sys_name", std::string_view("PX4"));
    log.keyed('I', "char[" + std::to_string(board.size()) + "] ver_hw", board);
    log.keyed('I', "uint32_t ver_sw_release", std::uint32_t{0x010E00FF});
    log.keyed('P', "float SYS_HITL", hitl).keyed('P', "float EKF2_GPS_DELAY", 110.0F);
    announce(log);
    const auto samples = static_cast<std::uint64_t>(seconds * 250.0);
    for (std::uint64_t k = 0; k <= samples; ++k) {
      const bool back = clock_steps_back && k > samples / 2;
      at(log, k, kBoot + 4000 * k - (back ? 3'000'000U : 0U));
    }
    return log;
  }

  std::filesystem::path write(const std::filesystem::path& file) const {
    UlogByHand made = log();
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(made.bytes().data()), static_cast<std::streamsize>(made.size()));
    return file;
  }

 private:
  void announce(UlogByHand& log) const {
    log.format(
        "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t "
        "accelerometer_timestamp_relative;float[3] accelerometer_m_s2;");
    log.format(
        "vehicle_gps_position:uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;int32_t lon;int32_t "
        "alt;float s_variance_m_s;float eph;float epv;float vel_n_m_s;float vel_e_m_s;float "
        "vel_d_m_s;uint8_t fix_type;bool vel_ned_valid;uint8_t satellites_used;");
    log.format("vehicle_magnetometer:uint64_t timestamp;float[3] magnetometer_ga;");
    log.format("vehicle_air_data:uint64_t timestamp;float baro_pressure_pa;");
    log.format("vehicle_attitude:uint64_t timestamp;float[4] q;");
    log.format(
        "vehicle_local_position:uint64_t timestamp;double ref_lat;double ref_lon;float x;float y;float z;"
        "float vx;float vy;float vz;float ref_alt;bool xy_valid;bool z_valid;bool v_xy_valid;bool v_z_valid;"
        "bool xy_global;");
    log.format("vehicle_land_detected:uint64_t timestamp;bool landed;");
    log.format(
        "vehicle_status:uint64_t timestamp;uint8_t arming_state;uint8_t nav_state;uint8_t hil_state;uint8_t "
        "vehicle_type;");
    if (imu) log.subscribe(0, 1, "sensor_combined");
    if (gnss) log.subscribe(0, 2, "vehicle_gps_position");
    if (mag) log.subscribe(0, 3, "vehicle_magnetometer");
    log.subscribe(0, 4, "vehicle_air_data");
    if (estimate) log.subscribe(0, 5, "vehicle_attitude").subscribe(0, 6, "vehicle_local_position");
    log.subscribe(0, 7, "vehicle_land_detected").subscribe(0, 8, "vehicle_status");
  }

  /// What is logged at sample `k` of the IMU. The vehicle stays where it is, level, nose north.
  void at(UlogByHand& log, std::uint64_t k, std::uint64_t now) const {
    const float nothing = std::nanf("");
    const bool gap = no_numbers && (k / 50) % 4 == 3;
    if (imu) {
      const float force = gap && k % 25 == 0 ? nothing : -9.81F;
      log.record(1, now, 0.0F, 0.0F, 0.0F, std::uint32_t{4000}, std::int32_t{0}, 0.0F, 0.0F, force);
    }
    if (k % 25 == 0) slow(log, k, now, gap ? nothing : 0.0F);
    if (k % 50 == 0 && gnss) fix(log, k, now, gap ? nothing : 0.0F);
    if (k % 250 == 0) state(log, 0.004 * static_cast<double>(k), now);
  }

  /// @param error  is added to every value
  void slow(UlogByHand& log, std::uint64_t k, std::uint64_t now, float error) const {
    const float jitter = k % 50 == 0 ? 2e-4F : -2e-4F;
    if (mag) log.record(3, now, 0.21F + error, jitter, 0.43F);
    log.record(4, now, 96'000.0F + error);
    if (!estimate) return;
    log.record(5, now, 1.0F + error, 0.0F, 0.0F, 0.0F);
    const std::uint8_t yes = 1;
    log.record(6, now, 47.3, 8.5, 0.0F + error, 0.0F, -0.5F, 0.0F, 0.0F, 0.0F, 432.0F, yes, yes, yes, yes,
               yes);
  }

  void fix(UlogByHand& log, std::uint64_t k, std::uint64_t now, float error) const {
    const bool off = jump && k == static_cast<std::uint64_t>(seconds * 125.0) / 50 * 50;
    const std::int32_t there = off ? 10'000 : 0;
    log.record(2, now, std::uint64_t{1'685'000'000'000'000}, std::int32_t{473'000'000} + there,
               std::int32_t{85'000'000}, std::int32_t{432'000}, 0.1F, 0.5F, 1.0F, error, 0.0F, 0.0F,
               std::uint8_t{3}, std::uint8_t{1}, std::uint8_t{14});
  }

  void state(UlogByHand& log, double time, std::uint64_t now) const {
    log.record(7, now, static_cast<std::uint8_t>(time < kTakeOff ? 1 : 0));
    const std::uint8_t mission = 3, home = 5;
    log.record(8, now, static_cast<std::uint8_t>(time < 1.0 ? 1 : 2), time < kReturn ? mission : home,
               hil_state, vehicle_type);
  }
};

}  // namespace ironbird::scenarios::test
