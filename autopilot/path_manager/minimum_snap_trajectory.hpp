#pragma once

#include <array>
#include <cstddef>

#include "autopilot/path_manager/motion.hpp"

namespace ironbird::autopilot {

/// A trajectory through a row of places whose snap, integrated and squared, is least: polynomials of degree
/// 7, at rest at both ends, continuous up to the sixth derivative in between. Position and heading are
/// planned alike.
///
/// A curve through places at unequal distances swings far out when each leg lasts what it would last alone.
/// So the durations are balanced: shortening any of them would cost about the same snap. A leg that still
/// strays from its chord is tied to it in the middle, then in the quarters; where that does not help the
/// trajectory ends early. Last, all durations are stretched by one factor, so that the greatest speed,
/// acceleration or jerk just meets its limit. Stretching does not change the path.
///
/// Source: Mellinger and Kumar, "Minimum snap trajectory generation and control for quadrotors", 2011, in the
/// form of a block-tridiagonal system for the derivatives at the places, of fixed size: nothing is allocated.
/// It does not avoid obstacles, and does not bound how far the heading swings.
class MinimumSnapTrajectory {
 public:
  static constexpr std::size_t kMostLegs = 32;
  /// Polynomials: a leg is one or several.
  static constexpr std::size_t kMostSegments = 64;

  /// Forgets all legs and begins at `p_N` (m) with `heading` (rad).
  void begin(const Vector3& p_N, double heading);

  /// Adds a leg to `p_N` (m) with `heading` (rad), flown at no more than `max_speed` (m/s, > 0). Turns the
  /// shortest way. Not more than kMostLegs.
  void add(const Vector3& p_N, double heading, double max_speed);

  /// Finds the polynomials and the durations. Drops the last legs when the path cannot be kept within
  /// `max_excursion` (m, > 0) of all chords; a single leg is its own chord.
  /// @return how many legs are left, >= 1 if there were any
  std::size_t solve(const MotionLimits& limits, double max_excursion);

  /// The point `elapsed` seconds after the beginning; before and after it rests at its ends.
  MotionPoint evaluate(double elapsed) const;

  std::size_t legs() const { return legs_; }
  /// s
  double duration() const { return ends_[segments_]; }
  /// End of leg `i`, s after the beginning.
  double end_of(std::size_t i) const;

 private:
  static constexpr int kDimensions = 4;  // north, east, down, heading
  using Knot = Eigen::Matrix<double, kDimensions, 1>;
  /// Velocity, acceleration and jerk of each dimension.
  using Slopes = Eigen::Matrix<double, 3, kDimensions>;
  using Coefficients = Eigen::Matrix<double, kDimensions, 8>;

  double duration_of(std::size_t i) const { return ends_[i + 1] - ends_[i]; }
  std::size_t stray_leg(const MotionLimits& limits, double max_excursion);
  bool tie(double max_excursion);
  void lay_out(const MotionLimits& limits);
  double usual_duration(std::size_t leg, const MotionLimits& limits) const;
  void fit();
  void balance(const MotionLimits& limits);
  double price(std::size_t i, double heading_weight) const;
  void solve_slopes();
  void fill_coefficients();
  void stretch(const MotionLimits& limits);
  double excess(std::size_t i, const MotionLimits& limits) const;
  Knot jerk_at(std::size_t i, double tau) const;
  double excursion(std::size_t i) const;

  std::size_t legs_ = 0;
  std::array<Knot, kMostLegs + 1> places_;
  std::array<double, kMostLegs> max_speeds_{};
  std::array<std::size_t, kMostLegs> pieces_{};  // segments of the leg

  std::size_t segments_ = 0;
  std::array<Knot, kMostSegments + 1> knots_;
  std::array<std::size_t, kMostSegments> leg_of_{};
  std::array<double, kMostSegments> usual_{};     // s, its share of what its leg would last alone
  std::array<double, kMostSegments + 1> ends_{};  // s; the first is the beginning
  std::array<Slopes, kMostSegments + 1> slopes_;
  std::array<Matrix3, kMostSegments + 1> elimination_;
  std::array<Coefficients, kMostSegments> coefficients_;  // of powers of t/duration
};

}  // namespace ironbird::autopilot
