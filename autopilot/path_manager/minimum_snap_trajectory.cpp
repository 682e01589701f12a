#include "autopilot/path_manager/minimum_snap_trajectory.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "autopilot/math/smoothstep.hpp"

namespace ironbird::autopilot {

namespace {

constexpr int kSamplesPerSegment = 64;
// Between two of the samples a peak of a polynomial of degree 7 rises by less than this.
constexpr double kSampleMargin = 1.005;

/// c4..c7 of the polynomial whose ends differ by `d` from its first four terms: rows for value, first,
/// second, third derivative in t/duration.
Eigen::Matrix4d upper_coefficients() {
  Eigen::Matrix4d m;
  m << 35.0, -15.0, 2.5, -1.0 / 6.0,  //
      -84.0, 39.0, -7.0, 0.5,         //
      70.0, -34.0, 6.5, -0.5,         //
      -20.0, 10.0, -2.0, 1.0 / 6.0;
  return m;
}

/// Fourth, fifth and sixth derivative, in t/duration, at one end of a segment, as linear functions of the way
/// covered and of the slopes at both ends.
struct HighDerivatives {
  Vector3 way;    ///< per end place minus start place
  Matrix3 start;  ///< per velocity, acceleration, jerk at the start
  Matrix3 end;    ///< per the same at the end
};

HighDerivatives high_derivatives(const Eigen::Matrix<double, 3, 4>& of_upper) {
  const Eigen::Matrix<double, 3, 4> per_difference = of_upper * upper_coefficients();
  Eigen::Matrix<double, 4, 3> start_terms;  // minus what the first four terms reach at the end
  start_terms << -1.0, -0.5, -1.0 / 6.0,    //
      -1.0, -1.0, -0.5,                     //
      0.0, -1.0, -1.0,                      //
      0.0, 0.0, -1.0;
  return {per_difference.col(0), per_difference * start_terms, per_difference.rightCols<3>()};
}

HighDerivatives at_start() {
  Eigen::Matrix<double, 3, 4> of_upper;
  of_upper << 24.0, 0.0, 0.0, 0.0,  //
      0.0, 120.0, 0.0, 0.0,         //
      0.0, 0.0, 720.0, 0.0;
  return high_derivatives(of_upper);
}

HighDerivatives at_end() {
  Eigen::Matrix<double, 3, 4> of_upper;
  of_upper << 24.0, 120.0, 360.0, 840.0,  //
      0.0, 120.0, 720.0, 2520.0,          //
      0.0, 0.0, 720.0, 5040.0;
  return high_derivatives(of_upper);
}

/// Velocity, acceleration and jerk per second become per t/duration.
Eigen::DiagonalMatrix<double, 3> to_unit(double duration) {
  return {duration, duration * duration, duration * duration * duration};
}

/// Fourth to sixth derivative per t/duration become per second.
Eigen::DiagonalMatrix<double, 3> to_seconds(double duration) {
  const double fourth = std::pow(duration, -4);
  return {fourth, fourth / duration, fourth / (duration * duration)};
}

}  // namespace

void MinimumSnapTrajectory::begin(const Vector3& p_N, double heading) {
  segments_ = 0;
  ends_[0] = 0.0;
  knots_[0] << p_N, heading;
}

void MinimumSnapTrajectory::add(const Vector3& p_N, double heading, double max_speed) {
  assert(segments_ < kMostSegments);
  max_speeds_[segments_] = max_speed;
  ++segments_;
  knots_[segments_] << p_N, unwrap_near(heading, knots_[segments_ - 1](3));
}

void MinimumSnapTrajectory::solve(const MotionLimits& limits) {
  allot(limits);
  if (duration() <= 0.0) return;
  solve_slopes();
  fill_coefficients();
  stretch(limits);
}

void MinimumSnapTrajectory::allot(const MotionLimits& limits) {
  for (std::size_t i = 0; i < segments_; ++i) {
    const Knot way = knots_[i + 1] - knots_[i];
    const double distance = way.head<3>().norm();
    const double turn = std::abs(way(3));
    const double speed = std::min(max_speeds_[i], limits.max_velocity);
    ends_[i + 1] = ends_[i] + std::max(smoothstep_duration(distance, speed, limits.max_acceleration),
                                       smoothstep_duration(turn, limits.max_heading_rate,
                                                           limits.max_heading_acceleration));
  }
}

void MinimumSnapTrajectory::solve_slopes() {
  const HighDerivatives start = at_start();
  const HighDerivatives end = at_end();
  // In units of the mean duration the blocks are of one size.
  const double unit = duration() / static_cast<double>(segments_);
  slopes_[0].setZero();
  slopes_[segments_].setZero();
  // Forward elimination; elimination_[i] holds what links slopes_[i] to slopes_[i + 1].
  elimination_[0].setZero();
  for (std::size_t i = 1; i < segments_; ++i) {
    const double before = duration_of(i - 1) / unit;
    const double after = duration_of(i) / unit;
    const Matrix3 link_back = to_seconds(before) * end.start * to_unit(before);
    const Matrix3 link_ahead = -(to_seconds(after) * start.end * to_unit(after));
    const Matrix3 own_before = to_seconds(before) * end.end * to_unit(before);
    const Matrix3 own_after = to_seconds(after) * start.start * to_unit(after);
    const Slopes right = (to_seconds(after) * start.way) * (knots_[i + 1] - knots_[i]).transpose() -
                         (to_seconds(before) * end.way) * (knots_[i] - knots_[i - 1]).transpose();
    const Matrix3 pivot = (own_before - own_after - link_back * elimination_[i - 1]).inverse();
    elimination_[i] = pivot * link_ahead;
    slopes_[i] = pivot * (right - link_back * slopes_[i - 1]);
  }
  for (std::size_t i = segments_; i-- > 1;) slopes_[i] -= elimination_[i] * slopes_[i + 1];
  const Eigen::DiagonalMatrix<double, 3> per_second(1.0 / unit, 1.0 / (unit * unit),
                                                    1.0 / (unit * unit * unit));
  for (std::size_t i = 1; i < segments_; ++i) slopes_[i] = per_second * slopes_[i];
}

void MinimumSnapTrajectory::fill_coefficients() {
  const Eigen::Matrix4d upper = upper_coefficients();
  for (std::size_t i = 0; i < segments_; ++i) {
    const double duration = duration_of(i);
    const Slopes from = to_unit(duration) * slopes_[i];
    const Slopes to = to_unit(duration) * slopes_[i + 1];
    Eigen::Matrix<double, 4, kDimensions> difference;
    difference.row(0) =
        (knots_[i + 1] - knots_[i]).transpose() - from.row(0) - from.row(1) / 2.0 - from.row(2) / 6.0;
    difference.row(1) = to.row(0) - from.row(0) - from.row(1) - from.row(2) / 2.0;
    difference.row(2) = to.row(1) - from.row(1) - from.row(2);
    difference.row(3) = to.row(2) - from.row(2);
    Coefficients& c = coefficients_[i];
    c.col(0) = knots_[i];
    c.col(1) = from.row(0).transpose();
    c.col(2) = from.row(1).transpose() / 2.0;
    c.col(3) = from.row(2).transpose() / 6.0;
    c.rightCols<4>() = (upper * difference).transpose();
  }
}

double MinimumSnapTrajectory::excess(std::size_t i, const MotionLimits& limits) const {
  const double speed = std::min(max_speeds_[i], limits.max_velocity);
  double most = 0.0;
  for (int sample = 0; sample <= kSamplesPerSegment; ++sample) {
    const double share = static_cast<double>(sample) / kSamplesPerSegment;
    const MotionPoint point = evaluate(ends_[i] + share * duration_of(i));
    most = std::max({most, point.v_N.norm() / speed, std::sqrt(point.a_N.norm() / limits.max_acceleration),
                     std::abs(point.heading_rate) / limits.max_heading_rate,
                     std::sqrt(std::abs(point.heading_acceleration) / limits.max_heading_acceleration)});
  }
  return most;
}

void MinimumSnapTrajectory::stretch(const MotionLimits& limits) {
  double factor = 0.0;
  for (std::size_t i = 0; i < segments_; ++i) factor = std::max(factor, excess(i, limits));
  factor *= kSampleMargin;
  for (std::size_t i = 0; i <= segments_; ++i) ends_[i] *= factor;
}

MotionPoint MinimumSnapTrajectory::evaluate(double elapsed) const {
  const auto first_end = ends_.begin() + 1;
  const auto last_end = first_end + static_cast<std::ptrdiff_t>(segments_);
  const auto found = std::upper_bound(first_end, last_end, elapsed);
  MotionPoint point;
  point.passed = static_cast<std::uint32_t>(found - first_end);
  point.ended = found == last_end;
  if (point.ended || elapsed < 0.0) {
    const Knot& knot = point.ended ? knots_[segments_] : knots_[0];
    point.p_N = knot.head<3>();
    point.heading = wrap(knot(3));
    return point;
  }
  const std::size_t i = point.passed;
  const Coefficients& c = coefficients_[i];
  const double per_second = 1.0 / duration_of(i);
  const double tau = (elapsed - ends_[i]) * per_second;
  Knot value = c.col(7);
  Knot first = Knot::Zero();
  Knot second = Knot::Zero();  // half the second derivative
  for (int power = 6; power >= 0; --power) {
    second = second * tau + first;
    first = first * tau + value;
    value = value * tau + c.col(power);
  }
  first *= per_second;
  second *= 2.0 * per_second * per_second;
  point.p_N = value.head<3>();
  point.v_N = first.head<3>();
  point.a_N = second.head<3>();
  point.heading = wrap(value(3));
  point.heading_rate = first(3);
  point.heading_acceleration = second(3);
  return point;
}

}  // namespace ironbird::autopilot
