#pragma once

#include <vector>

namespace ironbird::scenarios::plot {

struct Point {
  double x = 0.0;
  double y = 0.0;
  bool operator==(const Point&) const = default;
};

/// Thins a curve to what can be seen: of each of `bins` equal slices of [low, high] the first, the least, the
/// greatest and the last point stay, in order. Points outside the range are dropped, but for the nearest one
/// on each side. A y that is no number stays as a gap.
/// @param x  rising
std::vector<Point> thin(const std::vector<double>& x, const std::vector<double>& y, double low, double high,
                        int bins);

/// Drops points that lie within `tolerance` of the straight line between their neighbours that stay.
/// @param points  without gaps
std::vector<Point> straighten(const std::vector<Point>& points, double tolerance);

}  // namespace ironbird::scenarios::plot
