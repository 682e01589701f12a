#pragma once

#include <cstdint>
#include <optional>

#include "hil_bridge/virtual_fcu/board.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// Attitude of the body with respect to the world, single precision, w >= 0.
struct AttitudeQ {
  float w = 1.0F;
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("w", self.w, "1", "scalar");
    visit("x", self.x, "1", "vector part");
    visit("y", self.y, "1", "vector part");
    visit("z", self.z, "1", "vector part");
  }
};

/// What the filter believes. The angles are worked out when somebody asks: a companion that commands torques
/// never does.
struct Attitude {
  AttitudeQ q_NB;
  Triple w_NB_B;

  float roll() const;     ///< rad
  float pitch() const;    ///< rad
  float heading() const;  ///< rad, integrated from the gyro only

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit("w_NB_B", self.w_NB_B, "rad/s", "low-passed gyro minus adaptive bias");
  }
};

/// The firmware's explicit complementary filter: gyro integration that the accelerometer, or an attitude from
/// outside, pulls back. Single precision, oddities included: the quaternion is updated component by
/// component, each using those already updated.
///
/// The magnetometer is not used: heading drifts.
class AttitudeFilter {
 public:
  /// @param undefined_when_inverted  reproduce the firmware's division by zero when the low-passed
  /// accelerometer points exactly along +Bz; otherwise that sample corrects nothing and is counted
  explicit AttitudeFilter(bool undefined_when_inverted = false)
      : undefined_when_inverted_(undefined_when_inverted) {}

  void configure(const ParameterStore& parameters);

  /// Level, heading north, no bias. At boot and after an accelerometer calibration.
  void reset();
  /// After a gyro calibration.
  void reset_bias() { bias_ = {}; }

  /// Replaces the accelerometer in the next step that has a length. Taken as it is, not normalised; one that
  /// is not finite, or longer than 1000, is refused.
  void set_external(const AttitudeQ& q_NB);

  /// Takes one corrected sample. The first only starts the clock.
  /// @param dt  time since the previous sample, s
  void step(const ImuInput& imu, float dt);

  const Attitude& attitude() const { return attitude_; }
  const Triple& bias() const { return bias_; }

  /// No usable accelerometer for more than half a second, although it should be used.
  bool unhealthy() const { return unhealthy_; }
  /// How many samples were refused because the tilt they show has no direction.
  int undefined_tilts() const { return undefined_tilts_; }

 private:
  struct Correction {
    Triple error;
    float gain = 0.0F;
  };

  void low_pass(const ImuInput& imu);
  bool accelerometer_usable(float squared_norm) const;
  Correction accelerometer_correction(std::uint64_t stamp_us);
  Correction external_correction(std::uint64_t stamp_us, float dt);
  Triple smoothed_rate();
  void propagate(const Triple& w, float dt);

  Attitude attitude_;
  Triple bias_;
  Triple acceleration_;
  Triple rate_;
  Triple rate_before_;
  Triple rate_long_before_;
  std::optional<AttitudeQ> external_;
  bool started_ = false;
  bool unhealthy_ = false;
  bool undefined_when_inverted_ = false;
  int undefined_tilts_ = 0;
  std::uint64_t last_accelerometer_us_ = 0;
  std::uint64_t last_external_us_ = 0;

  float accelerometer_lpf_ = 0.0F;
  float gyro_xy_lpf_ = 0.0F;
  float gyro_z_lpf_ = 0.0F;
  float accelerometer_gain_ = 0.0F;
  float external_gain_ = 0.0F;
  float bias_gain_ = 0.0F;
  float least_squared_norm_ = 0.0F;
  float greatest_squared_norm_ = 0.0F;
  std::uint64_t fast_until_us_ = 0;
  bool use_accelerometer_ = true;
  bool watch_health_ = true;
  bool quadratic_ = true;
  bool closed_form_ = true;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
