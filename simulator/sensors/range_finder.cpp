#include "simulator/sensors/range_finder.hpp"

#include <algorithm>

namespace ironbird::simulator {

RangeFinder::RangeFinder(const RangeFinderParams& params, const SensorSite& /*site*/, double period,
                         std::uint64_t seed)
    : params_(params), error_(params.error, period, seed, "sensors/range_finder") {}

double RangeFinder::distance(const Truth& truth) const {
  const Vector3 p_NS_N = truth.p_NB_N + truth.q_NB * params_.p_BS_B;
  const double height = -p_NS_N.z();
  if (!params_.slant) return height;
  const Vector3 axis_N = truth.q_NB * Vector3::UnitZ();
  // height <= maximum * cosine, so that a beam along the horizon divides nothing by zero.
  return height < params_.maximum * axis_N.z() ? height / axis_N.z() : params_.maximum;
}

RangeReading RangeFinder::measure(const Truth& truth, Time now, const FaultState& /*faults*/,
                                  bool /*armed*/) {
  const double true_distance = distance(truth);
  const double noisy = error_.apply(true_distance);
  const bool inside = true_distance > params_.minimum && true_distance < params_.maximum;
  RangeReading reading;
  reading.taken = now;
  reading.range = std::clamp(inside ? noisy : true_distance, params_.minimum, params_.maximum);
  return reading;
}

}  // namespace ironbird::simulator
