#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// What can go wrong, or be done to the vehicle from outside.
enum class FaultKind : std::uint8_t {
  kRotorEfficiency,  ///< rotor `index` gives `magnitude` (0..1) of its thrust and torque
  kRotorLoss,        ///< rotor `index` stops
  kImuDropout,       ///< no samples
  kMagDropout,
  kBaroDropout,
  kGnssDropout,
  kImuNonFinite,  ///< samples are NaN
  kMagNonFinite,
  kBaroNonFinite,
  kGnssNonFinite,
  kAccelerometerBias,  ///< `vector` is added, m/s^2
  kGyroBias,           ///< `vector` is added, rad/s
  kMagBias,            ///< `vector` is added, T
  kBaroBias,           ///< `magnitude` is added, Pa
  kGnssJump,           ///< `vector` is added to the position, m in N
  kBatteryCharge,      ///< the battery has `magnitude` (0..1) of its charge left from now on
  kWind,               ///< `vector` is added to the wind, m/s in N
  kPayload             ///< `magnitude` kg are added at the centre of mass
};

constexpr std::array<std::pair<FaultKind, std::string_view>, 18> enumerators(FaultKind) {
  return {{{FaultKind::kRotorEfficiency, "rotor_efficiency"},
           {FaultKind::kRotorLoss, "rotor_loss"},
           {FaultKind::kImuDropout, "imu_dropout"},
           {FaultKind::kMagDropout, "mag_dropout"},
           {FaultKind::kBaroDropout, "baro_dropout"},
           {FaultKind::kGnssDropout, "gnss_dropout"},
           {FaultKind::kImuNonFinite, "imu_non_finite"},
           {FaultKind::kMagNonFinite, "mag_non_finite"},
           {FaultKind::kBaroNonFinite, "baro_non_finite"},
           {FaultKind::kGnssNonFinite, "gnss_non_finite"},
           {FaultKind::kAccelerometerBias, "accelerometer_bias"},
           {FaultKind::kGyroBias, "gyro_bias"},
           {FaultKind::kMagBias, "mag_bias"},
           {FaultKind::kBaroBias, "baro_bias"},
           {FaultKind::kGnssJump, "gnss_jump"},
           {FaultKind::kBatteryCharge, "battery_charge"},
           {FaultKind::kWind, "wind"},
           {FaultKind::kPayload, "payload"}}};
}

/// One fault. Begins when it is given to the world and ends when it is taken back.
struct Fault {
  FaultKind kind = FaultKind::kGnssDropout;
  int index = 0;
  double magnitude = 0.0;
  Vector3 vector = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("kind", self.kind, "1", "what goes wrong");
    visit("index", self.index, "1", "which rotor, from 0", 0.0, 7.0);
    visit("magnitude", self.magnitude, "SI", "how much; the unit is that of the kind");
    visit("vector", self.vector, "SI", "how much, per axis; the unit is that of the kind");
  }
};

}  // namespace ironbird::simulator
