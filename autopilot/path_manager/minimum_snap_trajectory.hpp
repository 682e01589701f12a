#pragma once

#include <array>
#include <cstddef>

#include "autopilot/path_manager/motion.hpp"

namespace ironbird::autopilot {

/// A trajectory through a row of places whose snap, integrated and squared, is least: polynomials of degree
/// 7, at rest at both ends, continuous up to the sixth derivative in between. Position and heading are
/// planned alike.
///
/// The duration of each segment is first what a smooth step would need; then all are stretched by one factor,
/// so that the greatest speed or acceleration just meets its limit. Stretching does not change the path.
/// Source: Mellinger and Kumar, "Minimum snap trajectory generation and control for quadrotors", 2011, in the
/// form of a block-tridiagonal system for the derivatives at the places, of fixed size: nothing is allocated.
/// It does not avoid obstacles.
class MinimumSnapTrajectory {
 public:
  static constexpr std::size_t kMostSegments = 64;

  /// Forgets all segments and begins at `p_N` (m) with `heading` (rad).
  void begin(const Vector3& p_N, double heading);

  /// Adds a segment to `p_N` (m) with `heading` (rad), flown at no more than `max_speed` (m/s, > 0). Turns
  /// the shortest way. Not more than kMostSegments.
  void add(const Vector3& p_N, double heading, double max_speed);

  /// Finds the polynomials and the durations.
  void solve(const MotionLimits& limits);

  /// The point `elapsed` seconds after the beginning; before and after it rests at its ends.
  MotionPoint evaluate(double elapsed) const;

  std::size_t segments() const { return segments_; }
  /// s
  double duration() const { return ends_[segments_]; }
  /// End of segment `i`, s after the beginning.
  double end_of(std::size_t i) const { return ends_[i + 1]; }

 private:
  static constexpr int kDimensions = 4;  // north, east, down, heading
  using Knot = Eigen::Matrix<double, kDimensions, 1>;
  /// Velocity, acceleration and jerk of each dimension.
  using Slopes = Eigen::Matrix<double, 3, kDimensions>;
  using Coefficients = Eigen::Matrix<double, kDimensions, 8>;

  double duration_of(std::size_t i) const { return ends_[i + 1] - ends_[i]; }
  void allot(const MotionLimits& limits);
  void solve_slopes();
  void fill_coefficients();
  void stretch(const MotionLimits& limits);
  double excess(std::size_t i, const MotionLimits& limits) const;

  std::size_t segments_ = 0;
  std::array<Knot, kMostSegments + 1> knots_;
  std::array<double, kMostSegments> max_speeds_{};
  std::array<double, kMostSegments + 1> ends_{};  // s; the first is the beginning
  std::array<Slopes, kMostSegments + 1> slopes_;
  std::array<Matrix3, kMostSegments + 1> elimination_;
  std::array<Coefficients, kMostSegments> coefficients_;  // of powers of t/duration
};

}  // namespace ironbird::autopilot
