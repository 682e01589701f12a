#pragma once

#include <cstdint>
#include <optional>

#include "hil_bridge/virtual_fcu/board.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// How many IMU samples a calibration averages: 2.5 s at 400 Hz.
inline constexpr int kImuCalibrationSamples = 1001;

/// What an IMU calibration found.
struct BiasResult {
  enum class Verdict : std::uint8_t {
    kAccepted,
    kMoved,    ///< the vehicle was not still
    kTooLarge  ///< the bias itself is not believable
  };

  Verdict verdict = Verdict::kAccepted;
  Triple bias;
  float norm = 0.0F;  ///< of the bias
};

/// Averages the gyro of a vehicle at rest. Accepted below 1 rad/s.
class GyroCalibration {
 public:
  void start() { *this = {}, running_ = true; }
  bool running() const { return running_; }
  /// @param w  rotated, uncorrected, rad/s. @return the result, with the last sample
  std::optional<BiasResult> add(const Triple& w);

 private:
  bool running_ = false;
  int count_ = 0;
  Triple sum_;
};

/// Averages the accelerometer of a vehicle that stands level and still. Refused when the readings spread by
/// more than 1 m/s^2 or the bias is 3 m/s^2 or more.
class AccelerometerCalibration {
 public:
  void start() { *this = {}, running_ = true; }
  bool running() const { return running_; }
  /// @param a            rotated, uncorrected, m/s^2
  /// @param temperature  K
  /// @param drift        ACC_*_TEMP_COMP, m/s^2/K
  std::optional<BiasResult> add(const Triple& a, float temperature, const Triple& drift);

 private:
  bool running_ = false;
  int count_ = 0;
  Triple sum_;
  float temperature_sum_ = 0.0F;
  Triple least_;
  Triple greatest_;
};

/// Averages a pressure, looked at once in every turn of the firmware's loop and taken when more than 20 ms
/// have passed: 128 are passed over, 127 averaged, and the next one ends it. With turns of 2.5 ms that is
/// 256 times 22.5 ms, 5.76 s. When the variance is too great it starts over.
class PressureCalibration {
 public:
  /// @param greatest_variance  Pa^2
  explicit PressureCalibration(float greatest_variance) : greatest_variance_(greatest_variance) {}

  enum class Outcome : std::uint8_t { kNone, kDone, kUnsteady };

  void start();
  bool running() const { return running_; }
  /// @param pressure  the latest, new or not, Pa
  /// @param now_ms    board clock
  Outcome add(float pressure, std::uint32_t now_ms);
  /// Pa, of the last finished run.
  float mean() const { return mean_; }

 private:
  float greatest_variance_;
  bool running_ = false;
  int count_ = 0;
  std::uint32_t last_ms_ = 0;
  float mean_ = 0.0F;
  float variance_ = 0.0F;
};

inline constexpr float kBaroVariance = 25.0F;                   ///< Pa^2
inline constexpr float kDifferentialPressureVariance = 100.0F;  ///< Pa^2

}  // namespace ironbird::hil_bridge::virtual_fcu
