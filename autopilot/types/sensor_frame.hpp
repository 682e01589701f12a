#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// One sample of the inertial measurement unit: the heartbeat of the autopilot. Bias-corrected by the FCU,
/// unfiltered.
struct ImuSample {
  Time stamp{};
  Vector3 f_B = Vector3::Zero();
  Vector3 w_NB_B = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the sample was taken");
    visit("f_B", self.f_B, "m/s^2", "specific force at the IMU; level and at rest (0, 0, -g)");
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity of B in N");
  }
};

/// The magnetic field in the body frame. Only its direction is used: the wire does not fix its unit.
struct MagSample {
  Time stamp{};
  Vector3 m_B = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the sample arrived: the wire carries no stamp");
    visit("m_B", self.m_B, "1",
          "magnetic field, hard and soft iron removed, in whatever unit the FCU was calibrated to");
  }
};

/// Absolute static pressure.
struct BaroSample {
  Time stamp{};
  double pressure = 101325.0;
  double temperature = 288.15;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the sample arrived: the wire carries no stamp");
    visit("pressure", self.pressure, "Pa", "absolute static pressure");
    visit("temperature", self.temperature, "K", "temperature of the sensor");
  }
};

/// How good a satellite fix is. The values are those of the wire.
enum class GnssFix : std::uint8_t {
  kNone = 0,
  kDeadReckoning = 1,
  kFix2D = 2,
  kFix3D = 3,
  kGnssAndDeadReckoning = 4,
  kTimeOnly = 5,
  kRtkFloat = 6,
  kRtkFixed = 7
};

constexpr std::array<std::pair<GnssFix, std::string_view>, 8> enumerators(GnssFix) {
  return {{{GnssFix::kNone, "none"},
           {GnssFix::kDeadReckoning, "dead_reckoning"},
           {GnssFix::kFix2D, "fix_2d"},
           {GnssFix::kFix3D, "fix_3d"},
           {GnssFix::kGnssAndDeadReckoning, "gnss_and_dead_reckoning"},
           {GnssFix::kTimeOnly, "time_only"},
           {GnssFix::kRtkFloat, "rtk_float"},
           {GnssFix::kRtkFixed, "rtk_fixed"}}};
}

/// True for a fix whose position and velocity may be used.
constexpr bool is_usable(GnssFix fix) {
  return fix == GnssFix::kFix3D || fix == GnssFix::kGnssAndDeadReckoning || fix == GnssFix::kRtkFloat ||
         fix == GnssFix::kRtkFixed;
}

/// Position and velocity from a satellite receiver.
struct GnssSample {
  Time stamp{};
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;
  Vector3 v_NB_N = Vector3::Zero();
  double horizontal_accuracy = 0.0;
  double vertical_accuracy = 0.0;
  double speed_accuracy = 0.0;
  GnssFix fix = GnssFix::kNone;
  int satellites = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the fix was valid, not when it arrived");
    visit("latitude", self.latitude, "rad", "geodetic latitude, north positive");
    visit("longitude", self.longitude, "rad", "longitude, east positive");
    visit("altitude", self.altitude, "m", "height above mean sea level");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity over ground");
    visit("horizontal_accuracy", self.horizontal_accuracy, "m", "the receiver's own estimate, 1 sigma");
    visit("vertical_accuracy", self.vertical_accuracy, "m", "the receiver's own estimate, 1 sigma");
    visit("speed_accuracy", self.speed_accuracy, "m/s", "the receiver's own estimate, 1 sigma");
    visit("fix", self.fix, "1", "kind of fix");
    visit("satellites", self.satellites, "1", "satellites in use");
  }
};

/// A pose from outside, for example motion capture.
struct ExternalPose {
  Time stamp{};
  Vector3 p_NB_N = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Vector3 v_NB_N = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the pose was valid");
    visit("p_NB_N", self.p_NB_N, "m", "position of B from the local origin");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity of B in N");
  }
};

/// What the FCU says of itself.
struct FcuStatus {
  Time stamp{};
  bool armed = false;
  bool failsafe = false;
  bool offboard = false;
  int rc_override = 0;
  int error_code = 0;
  bool imu_calibrated = true;
  double battery_voltage = 0.0;
  std::optional<double> greatest_output = {};
  Time output_stamp{};

  /// The pilot's switches or sticks hold an axis: bits 0 to 4 of the wire. The bits above say that the
  /// companion was not heard, or that the pilot's throttle is the lower one.
  bool pilot_holds() const { return (rc_override & 0x1F) != 0; }
  /// The pilot's throttle is the lower one, and is flown.
  bool throttle_limited() const { return (rc_override & 0x20) != 0; }
  /// The motors do not obey the companion, whatever the reason.
  bool overridden() const { return failsafe || rc_override != 0; }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the status arrived");
    visit("armed", self.armed, "1", "motors may turn");
    visit("failsafe", self.failsafe, "1", "the FCU flies its failsafe command");
    visit("offboard", self.offboard, "1", "a command of the companion is still valid");
    visit("rc_override", self.rc_override, "1",
          "bits: which axes the pilot holds and why; 0: the companion has them all");
    visit("error_code", self.error_code, "1", "bits: faults that the FCU reports");
    visit("imu_calibrated", self.imu_calibrated, "1",
          "0: the offsets of the inertial unit are still to be found");
    visit("battery_voltage", self.battery_voltage, "V",
          "low-passed battery voltage; 0 before the first reading");
    visit("greatest_output", self.greatest_output, "1",
          "of what the motors were driven with last, whoever drives them; none: the FCU has not said");
    visit("output_stamp", self.output_stamp, "ns", "when that arrived");
  }
};

/// Everything the FCU reported since the previous tick: one IMU sample and at most one of each slower sensor.
struct SensorFrame {
  ImuSample imu;
  std::optional<MagSample> mag;
  std::optional<BaroSample> baro;
  std::optional<GnssSample> gnss;
  std::optional<ExternalPose> external_pose;
  std::optional<FcuStatus> status;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("imu", self.imu, "", "inertial measurement unit");
    visit("mag", self.mag, "", "magnetometer, when a sample arrived");
    visit("baro", self.baro, "", "barometer, when a sample arrived");
    visit("gnss", self.gnss, "", "satellite receiver, when a fix arrived");
    visit("external_pose", self.external_pose, "", "pose from outside, when one arrived");
    visit("status", self.status, "", "state of the FCU, when it arrived");
  }
};

}  // namespace ironbird::autopilot
