#include "autopilot/path_manager/minimum_snap_trajectory.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace ironbird::autopilot {

namespace {

constexpr int kSamplesPerSegment = 64;
// Halves, quarters, eighths of a leg.
constexpr int kMostTies = 3;
// Plans that may be dropped for a shorter one before a single leg is flown: it bounds the work.
constexpr int kMostAttempts = 3;
constexpr int kBalancingRounds = 8;
constexpr double kLeastPriceRatio = 1e-3;  // so that no step goes beyond a factor of 2.4
constexpr double kShortestShare = 0.7;     // of what the segment would last alone
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
  legs_ = segments_ = 0;
  ends_[0] = 0.0;
  places_[0] << p_N, heading;
}

void MinimumSnapTrajectory::add(const Vector3& p_N, double heading, double max_speed) {
  assert(legs_ < kMostLegs);
  max_speeds_[legs_] = max_speed;
  ++legs_;
  places_[legs_] << p_N, unwrap_near(heading, places_[legs_ - 1](3));
}

std::size_t MinimumSnapTrajectory::solve(const MotionLimits& limits, double max_excursion) {
  for (int attempt = 1; legs_ > 0; ++attempt) {
    const std::size_t stray = stray_leg(limits, max_excursion);
    if (stray == legs_) break;
    legs_ = attempt == kMostAttempts ? 1 : std::max<std::size_t>(stray, 1);
  }
  if (duration() > 0.0) stretch(limits);
  return legs_;
}

// Plans all legs; the first of them that strays too far although it is tied, or legs_.
std::size_t MinimumSnapTrajectory::stray_leg(const MotionLimits& limits, double max_excursion) {
  pieces_.fill(1);
  for (int ties = 0;; ++ties) {
    lay_out(limits);
    if (duration() <= 0.0) return legs_;
    balance(limits);
    const std::array<std::size_t, kMostLegs> before = pieces_;
    const bool fits = tie(max_excursion);
    const auto stray = std::mismatch(before.begin(), before.end(), pieces_.begin()).first;
    if (stray == before.end()) return legs_;
    if (!fits || ties == kMostTies) return static_cast<std::size_t>(stray - before.begin());
  }
}

// Doubles the pieces of the legs that stray. False when there would be too many.
bool MinimumSnapTrajectory::tie(double max_excursion) {
  std::array<bool, kMostLegs> strays{};
  for (std::size_t i = 0; i < segments_; ++i) {
    if (excursion(i) > max_excursion) strays[leg_of_[i]] = true;
  }
  std::size_t total = 0;
  for (std::size_t leg = 0; leg < legs_; ++leg) {
    if (strays[leg]) pieces_[leg] *= 2;
    total += pieces_[leg];
  }
  return total <= kMostSegments;
}

void MinimumSnapTrajectory::lay_out(const MotionLimits& limits) {
  segments_ = 0;
  knots_[0] = places_[0];
  for (std::size_t leg = 0; leg < legs_; ++leg) {
    const auto pieces = static_cast<double>(pieces_[leg]);
    const double usual = usual_duration(leg, limits) / pieces;
    for (std::size_t piece = 1; piece <= pieces_[leg]; ++piece) {
      leg_of_[segments_] = leg;
      usual_[segments_] = usual;
      ends_[segments_ + 1] = ends_[segments_] + usual;
      ++segments_;
      const double share = static_cast<double>(piece) / pieces;
      knots_[segments_] = places_[leg] + share * (places_[leg + 1] - places_[leg]);
    }
    knots_[segments_] = places_[leg + 1];
  }
}

double MinimumSnapTrajectory::usual_duration(std::size_t leg, const MotionLimits& limits) const {
  const Knot way = places_[leg + 1] - places_[leg];
  return leg_duration(way.head<3>().norm(), std::abs(way(3)), max_speeds_[leg], limits);
}

void MinimumSnapTrajectory::fit() {
  solve_slopes();
  fill_coefficients();
}

// At the optimum the price of time is the same everywhere. Alone, a segment's price falls with the eighth
// power of its duration: the step to take is the eighth root of how far it is off.
void MinimumSnapTrajectory::balance(const MotionLimits& limits) {
  const double heading_weight = limits.max_velocity / limits.max_heading_rate;  // m/rad
  fit();
  for (int round = 0; round < kBalancingRounds && segments_ > 1; ++round) {
    std::array<double, kMostSegments> prices;
    double mean = 0.0;
    for (std::size_t i = 0; i < segments_; ++i) {
      prices[i] = std::max(price(i, heading_weight), 0.0);
      mean += prices[i] * duration_of(i) / duration();
    }
    if (!(mean > 0.0)) return;
    double begin = 0.0;
    for (std::size_t i = 0; i < segments_; ++i) {
      const double off = std::clamp(prices[i] / mean, kLeastPriceRatio, 1.0 / kLeastPriceRatio);
      const double step = std::sqrt(std::sqrt(std::sqrt(off)));
      const double duration = std::max(step * (ends_[i + 1] - begin), kShortestShare * usual_[i]);
      begin = ends_[i + 1];
      ends_[i + 1] = ends_[i] + duration;
    }
    fit();
  }
}

// What a shorter segment would cost: minus the derivative of its integral of squared snap to its duration,
// with everything at its ends held. It is constant along the segment, as the Hamiltonian of the problem:
// x4 x4 - 2 x3 x5 + 2 x2 x6 - 2 x1 x7 with xn the n-th derivative, here at the start.
double MinimumSnapTrajectory::price(std::size_t i, double heading_weight) const {
  const Coefficients& c = coefficients_[i];
  const Knot each = 576.0 * c.col(4).cwiseAbs2() - 1440.0 * c.col(3).cwiseProduct(c.col(5)) +
                    2880.0 * c.col(2).cwiseProduct(c.col(6)) - 10080.0 * c.col(1).cwiseProduct(c.col(7));
  const double squared = duration_of(i) * duration_of(i);
  const double fourth = squared * squared;
  return (each.head<3>().sum() + heading_weight * heading_weight * each(3)) / (fourth * fourth);
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
  const double speed = std::min(max_speeds_[leg_of_[i]], limits.max_velocity);
  double most = 0.0;
  double most_jerk = 0.0;  // in greatest accelerations a second
  for (int sample = 0; sample <= kSamplesPerSegment; ++sample) {
    const double share = static_cast<double>(sample) / kSamplesPerSegment;
    const MotionPoint point = evaluate(ends_[i] + share * duration_of(i));
    const Knot jerk = jerk_at(i, share);
    most_jerk = std::max({most_jerk, jerk.head<3>().norm() / limits.max_acceleration,
                          std::abs(jerk(3)) / limits.max_heading_acceleration});
    most = std::max({most, point.v_N.norm() / speed, std::sqrt(point.a_N.norm() / limits.max_acceleration),
                     std::abs(point.heading_rate) / limits.max_heading_rate,
                     std::sqrt(std::abs(point.heading_acceleration) / limits.max_heading_acceleration)});
  }
  return std::max(most, std::cbrt(most_jerk * limits.rise_time));
}

MinimumSnapTrajectory::Knot MinimumSnapTrajectory::jerk_at(std::size_t i, double tau) const {
  const Coefficients& c = coefficients_[i];
  const Knot in_tau =
      6.0 * c.col(3) +
      tau * (24.0 * c.col(4) + tau * (60.0 * c.col(5) + tau * (120.0 * c.col(6) + tau * 210.0 * c.col(7))));
  const double duration = duration_of(i);
  return in_tau / (duration * duration * duration);
}

// Greatest distance of segment `i` from the chord of its leg, m.
double MinimumSnapTrajectory::excursion(std::size_t i) const {
  const Vector3 from_N = places_[leg_of_[i]].head<3>();
  const Vector3 chord_N = places_[leg_of_[i] + 1].head<3>() - from_N;
  const double length_squared = chord_N.squaredNorm();
  double most = 0.0;
  for (int sample = 0; sample < kSamplesPerSegment; ++sample) {
    const double share = static_cast<double>(sample) / kSamplesPerSegment;
    const Vector3 gone_N = evaluate(ends_[i] + share * duration_of(i)).p_N - from_N;
    const double along = length_squared > 0.0 ? gone_N.dot(chord_N) / length_squared : 0.0;
    most = std::max(most, (gone_N - std::clamp(along, 0.0, 1.0) * chord_N).norm());
  }
  return most;
}

void MinimumSnapTrajectory::stretch(const MotionLimits& limits) {
  double factor = 0.0;
  for (std::size_t i = 0; i < segments_; ++i) factor = std::max(factor, excess(i, limits));
  factor *= kSampleMargin;
  for (std::size_t i = 0; i <= segments_; ++i) ends_[i] *= factor;
}

double MinimumSnapTrajectory::end_of(std::size_t i) const {
  std::size_t end = 0;
  while (end < segments_ && leg_of_[end] <= i) ++end;
  return ends_[end];
}

MotionPoint MinimumSnapTrajectory::evaluate(double elapsed) const {
  const auto first_end = ends_.begin() + 1;
  const auto last_end = first_end + static_cast<std::ptrdiff_t>(segments_);
  const auto found = std::upper_bound(first_end, last_end, elapsed);
  MotionPoint point;
  const auto i = static_cast<std::size_t>(found - first_end);
  point.ended = found == last_end;
  point.passed = static_cast<std::uint32_t>(point.ended ? legs_ : leg_of_[i]);
  if (point.ended || elapsed < 0.0) {
    const Knot& knot = point.ended ? knots_[segments_] : knots_[0];
    point.p_N = knot.head<3>();
    point.heading = wrap(knot(3));
    return point;
  }
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
