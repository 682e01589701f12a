#pragma once

#include <string>
#include <vector>

namespace ironbird::scenarios::plot {

/// A numbered axis: a range and round numbers in it.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double step = 0.2;
  std::vector<double> ticks;

  /// The number at a tick, with as many decimals as the step needs; no "-0".
  std::string label(double tick) const;
};

/// A range of the numbers that are finite.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool empty = true;

  void include(double value);
  void include(const std::vector<double>& values);
};

/// The step 1, 2 or 5 times a power of ten that divides `span` into at most `most` parts, > 0.
double nice_step(double span, int most);

/// An axis over exactly `range`, with ticks at the multiples of a nice step inside it.
/// @param most_ticks  parts to divide it into at most, >= 1; more when fewer than three ticks would result
Axis tight_axis(const Range& range, int most_ticks);

/// An axis over `range` with a little air at both ends; a range without width is widened to at least
/// `least_span`.
Axis roomy_axis(const Range& range, int most_ticks, double least_span);

}  // namespace ironbird::scenarios::plot
