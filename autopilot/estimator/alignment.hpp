#pragma once

#include <array>

#include "autopilot/estimator/aiding_params.hpp"
#include "autopilot/estimator/impulse_history.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// An attitude out of two directions, and how well the second of them could tell the heading.
struct AttitudeFromVectors {
  Quaternion q_NB = Quaternion::Identity();
  double ambiguity = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit(
        "ambiguity", self.ambiguity, "1",
        "of the two headings at which the field lies in its plane; 0: at one of them it points as far south "
        "as at the other north; above 0.5: less than 120 degrees apart, or both north; 1: one, or none",
        0.0, 1.0);
  }
};

/// The attitude that turns the measured directions into the known ones: the specific force `f_B` into
/// a_N - g e_d, and the magnetic field `m_B` into the vertical plane of magnetic north. Closed form.
/// @param f_B  specific force, m/s^2, not zero
/// @param a_N  acceleration of the vehicle, m/s^2; zero at rest
/// @param m_B  magnetic field, any unit, not zero
/// @param declination  rad
AttitudeFromVectors attitude_from_vectors(const Vector3& f_B, const Vector3& a_N, const Vector3& m_B,
                                          double declination, double gravity);

/// The mean of those of the first `count` values that are no outliers: within twice the interquartile range
/// (but at least 2) of the quartiles. Works for any count >= 1. Sorts the values.
double mean_without_outliers(std::array<double, 512>& values, int count);

/// Where a filter starts.
struct StartState {
  LocalOrigin origin;
  Vector3 p_NB_N = Vector3::Zero();
  Vector3 v_NB_N = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Vector3 gyro_bias_B = Vector3::Zero();
  Vector3 accelerometer_offset_B = Vector3::Zero();
  Vector3 m_B = Vector3::Zero();
  double origin_pressure = 101325.0;
  bool moving = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("origin", self.origin, "", "where N begins");
    visit("p_NB_N", self.p_NB_N, "m", "position of B from the local origin");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity over ground");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit("gyro_bias_B", self.gyro_bias_B, "rad/s", "mean rate at rest; 0 in motion");
    visit("accelerometer_offset_B", self.accelerometer_offset_B, "m/s^2",
          "part of the accelerometer's bias along gravity; 0 in motion");
    visit("m_B", self.m_B, "1", "unit vector of the field that the heading is from; 0: it is from elsewhere");
    visit("origin_pressure", self.origin_pressure, "Pa", "static pressure at height 0");
    visit("moving", self.moving, "1", "the vehicle was not at rest");
  }
};

/// Finds the first state of a filter: at rest from means of accelerometer, gyro, compass, barometer and
/// satellite fixes; in motion from the same with the rotation taken out and the acceleration from the
/// satellite velocity. The fixes have to tell of half of the least time of averaging, and exactly the forces
/// of that time count, whenever the fixes arrived: in a turn the acceleration of one part says nothing of
/// another. While the vehicle accelerates so hard that the steep field leaves two headings open, it goes on
/// averaging: over a longer time the mean acceleration is less.
///
/// At rest the accelerometer measures -R^T g e_d + bias. Tilt and the horizontal bias cannot be told apart
/// there, and are not: tilt takes all of it. Only |f| - g along f is seen, and is kept as the accelerometer's
/// offset. On the ground it waits until the FCU has found the offsets of its inertial unit, which step then.
class Alignment {
 public:
  void reset();

  /// Begins anew for a vehicle in flight: does not wait for it to come to rest.
  void restart_in_motion();

  /// Adds one frame. @return true when the start is found
  bool add(const SensorFrame& frame, double dt, const AidingParams& params);

  /// Valid after `add` returned true.
  const StartState& start() const { return start_; }

 private:
  struct Window {
    Time begin{0};
    int imu = 0;
    Vector3 f_sum_B = Vector3::Zero();
    Vector3 w_sum_B = Vector3::Zero();
    Vector3 f_square_sum_B = Vector3::Zero();
    Vector3 w_square_sum_B = Vector3::Zero();
    Vector3 f_first_B = Vector3::Zero();
    Vector3 w_first_B = Vector3::Zero();
    Quaternion turned = Quaternion::Identity();  ///< B now to B at the beginning
    ImpulseHistory impulse;                      ///< in B at the beginning
    Vector3 m_sum_begin = Vector3::Zero();
    Vector3 m_sum_B = Vector3::Zero();
    int mag = 0;
    int fixes = 0;
    GnssSample first_fix;
    // The time that fixes tell of, between two whose stamps are within the history.
    bool told = false;
    GnssSample told_first;
    GnssSample told_last;
    Vector3 told_first_impulse = Vector3::Zero();
    Vector3 told_last_impulse = Vector3::Zero();
    double latitude_sum = 0.0;
    double longitude_sum = 0.0;
    double altitude_sum = 0.0;
    double fastest = 0.0;
    int baro = 0;
    double last_pressure = 0.0;
  };

  void collect(const SensorFrame& frame, double dt);
  void add_imu(const ImuSample& imu, double dt);
  void add_fix(const GnssSample& fix);
  void add_told(const GnssSample& fix);
  void begin_window(Time now);
  double told_span() const;
  bool is_still(const AidingParams& params) const;
  void find_at_rest(const AidingParams& params);
  /// @return false when the heading is open, or the last fix is old
  bool find_in_motion(const AidingParams& params, Time now);

  Window window_;
  std::array<double, 512> pressures_{};
  Time first_stamp_{0};
  bool started_ = false;
  bool armed_ = false;
  bool imu_calibrated_ = true;
  StartState start_;
};

}  // namespace ironbird::autopilot
