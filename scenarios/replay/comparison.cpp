#include "scenarios/replay/comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "autopilot/math/angles.hpp"
#include "autopilot/math/euler_zyx.hpp"
#include "autopilot/math/local_map.hpp"
#include "scenarios/config/degrees.hpp"
#include "scenarios/requirements/difference_metrics.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Quaternion;
using autopilot::StateEstimate;
using autopilot::Vector3;
using hil_bridge::Time;

Vector3 no_numbers() {
  return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
}

Vector3 between(const Vector3& from, const Vector3& to, double share) {
  return from + share * (to - from);
}

}  // namespace

Vector3 seen_from(const autopilot::LocalOrigin& other, const Vector3& p_N,
                  const autopilot::LocalOrigin& origin) {
  if (!other.known || !origin.known) return p_N;
  return autopilot::local_from_geodetic(autopilot::geodetic_from_local(p_N, origin), other);
}

Comparison::Comparison(const RecordedEstimate& recorded, Interval window)
    : recorded_(recorded), window_(window) {
  for (const RecordedAttitude& attitude : recorded.attitudes)
    wanted_attitudes_ += counts(attitude.stamp) ? 1 : 0;
  for (const RecordedPosition& position : recorded.positions) {
    if (!counts(position.stamp)) continue;
    wanted_positions_ += position.position_known ? 1 : 0;
    wanted_heights_ += position.height_known ? 1 : 0;
    wanted_velocities_ += position.velocity_known ? 1 : 0;
  }
}

void Comparison::Sum::add(double value) {
  if (!std::isfinite(value)) return;
  ++count;
  sum += value;
  squares += value * value;
}

double Comparison::Sum::rms() const {
  return count == 0 ? std::numeric_limits<double>::quiet_NaN()
                    : std::sqrt(squares / static_cast<double>(count));
}

double Comparison::Sum::deviation() const {
  if (count == 0) return std::numeric_limits<double>::quiet_NaN();
  const double mean = sum / static_cast<double>(count);
  return std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean * mean));
}

const std::vector<EstimateDifference>& Comparison::observe(const StateEstimate& ours) {
  differences_.clear();
  const Time now = ours.stamp;
  const bool usable = autopilot::is_usable(ours.health);
  const auto pass = [&](const auto& series, std::size_t& next) {
    for (; next < series.size() && series[next].stamp <= now; ++next) {
      const Time when = series[next].stamp;
      const bool spanned = usable && before_ && before_->stamp <= when;
      if (!spanned) continue;
      const double length = static_cast<double>((now - before_->stamp).count());
      const double share = length > 0.0 ? static_cast<double>((when - before_->stamp).count()) / length : 1.0;
      compare(series[next], share, ours);
    }
  };
  pass(recorded_.attitudes, next_attitude_);
  pass(recorded_.positions, next_position_);
  before_ = usable ? std::optional(ours) : std::nullopt;
  return differences_;
}

void Comparison::compare(const RecordedAttitude& recorded, double share, const StateEstimate& ours) {
  const Quaternion q_NB = before_->q_NB.slerp(share, ours.q_NB);
  const Vector3 theta = autopilot::euler_from_quaternion(q_NB);
  const Vector3 other = autopilot::euler_from_quaternion(recorded.q_NB);
  EstimateDifference difference{recorded.stamp, no_numbers(), no_numbers(), {}};
  for (int axis = 0; axis < 3; ++axis) {
    difference.theta(axis) = autopilot::shortest_difference(theta(axis), other(axis));
  }
  differences_.push_back(difference);
  if (!counts(recorded.stamp)) return;
  roll_.add(difference.theta.x());
  pitch_.add(difference.theta.y());
  heading_.add(difference.theta.z());
}

void Comparison::compare(const RecordedPosition& recorded, double share, const StateEstimate& ours) {
  EstimateDifference difference{recorded.stamp, no_numbers(), no_numbers(), no_numbers()};
  const Vector3 p_N = seen_from(recorded_.origin, between(before_->p_NB_N, ours.p_NB_N, share), ours.origin);
  if (recorded.position_known && ours.position_known)
    difference.p_N.head<2>() = (p_N - recorded.p_NB_N).head<2>();
  if (recorded.height_known) difference.p_N.z() = (p_N - recorded.p_NB_N).z();
  if (recorded.velocity_known && ours.position_known)
    difference.v_N = between(before_->v_NB_N(), ours.v_NB_N(), share) - recorded.v_NB_N;
  differences_.push_back(difference);
  if (!counts(recorded.stamp)) return;
  north_.add(difference.p_N.x());
  east_.add(difference.p_N.y());
  horizontal_.add(difference.p_N.head<2>().norm());
  down_.add(difference.p_N.z());
  velocity_.add(difference.v_N.norm());
}

std::vector<Metric> Comparison::results() const {
  double share = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [sum, wanted] :
       {std::pair(&roll_, wanted_attitudes_), std::pair(&horizontal_, wanted_positions_),
        std::pair(&down_, wanted_heights_), std::pair(&velocity_, wanted_velocities_)}) {
    if (wanted == 0) continue;
    const double compared = static_cast<double>(sum->count) / static_cast<double>(wanted);
    share = std::isnan(share) ? compared : std::min(share, compared);
  }
  const std::array<double, 9> values{horizontal_.rms(),
                                     north_.rms(),
                                     east_.rms(),
                                     down_.deviation(),
                                     velocity_.rms(),
                                     kDegreesPerRadian * roll_.rms(),
                                     kDegreesPerRadian * pitch_.rms(),
                                     kDegreesPerRadian * heading_.rms(),
                                     share};
  std::vector<Metric> all = difference_metrics(recorded_.name);
  for (std::size_t k = 0; k < values.size(); ++k) all.at(k).value = values[k];
  return all;
}

}  // namespace ironbird::scenarios
