#include "simulator/sensors/gnss.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace ironbird::simulator {

Gnss::Gnss(const GnssParams& params, const SensorSite& site, double period, std::uint64_t seed)
    : params_(params),
      site_(site),
      parallel_radius_(kEarthRadius * std::cos(site.latitude)),
      north_(params.horizontal, period, seed, "sensors/gnss/north"),
      east_(params.horizontal, period, seed, "sensors/gnss/east"),
      altitude_(params.vertical, period, seed, "sensors/gnss/altitude"),
      velocity_{ScalarError(params.velocity, period, seed, "sensors/gnss/velocity/x"),
                ScalarError(params.velocity, period, seed, "sensors/gnss/velocity/y"),
                ScalarError(params.velocity, period, seed, "sensors/gnss/velocity/z")} {}

GnssReading Gnss::measure(const Truth& truth, Time now, const FaultState& faults, bool /*armed*/) {
  const Vector3 p_NA_N = truth.p_NB_N + truth.q_NB * params_.p_BA_B;
  const Vector3 v_NA_N = truth.v_NB_N + truth.q_NB * truth.w_NB_B.cross(params_.p_BA_B);
  const Vector3& jump_N = faults.gnss_jump_N;

  GnssReading reading;
  reading.taken = now;
  reading.latitude = site_.latitude + north_.apply(p_NA_N.x(), jump_N.x()) / kEarthRadius;
  reading.longitude = std::remainder(site_.longitude + east_.apply(p_NA_N.y(), jump_N.y()) / parallel_radius_,
                                     2.0 * std::numbers::pi);
  reading.altitude = site_.altitude + altitude_.apply(-p_NA_N.z(), -jump_N.z());
  for (int i = 0; i < 3; ++i) {
    reading.v_NB_N[i] = velocity_[static_cast<std::size_t>(i)].apply(v_NA_N[i]);
  }
  reading.horizontal_accuracy = params_.horizontal_accuracy;
  reading.vertical_accuracy = params_.vertical_accuracy;
  reading.speed_accuracy = params_.speed_accuracy;
  reading.fix = params_.fix;
  reading.satellites = params_.satellites;
  return reading;
}

}  // namespace ironbird::simulator
