#include "scenarios/report/plot/decimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ironbird::scenarios::plot {

namespace {

/// Appends the points of [begin, end) that show the shape of the slice.
void append_slice(std::vector<Point>& out, const std::vector<double>& x, const std::vector<double>& y,
                  std::size_t begin, std::size_t end) {
  std::array<std::size_t, 4> keep{begin, begin, begin, end - 1};
  bool has_gap = false;
  for (std::size_t i = begin; i < end; ++i) {
    has_gap = has_gap || !std::isfinite(y[i]);
    if (!(y[i] >= y[keep[1]])) keep[1] = std::isfinite(y[i]) ? i : keep[1];
    if (!(y[i] <= y[keep[2]])) keep[2] = std::isfinite(y[i]) ? i : keep[2];
  }
  if (has_gap) {  // rare: keep every point
    for (std::size_t i = begin; i < end; ++i) out.push_back({x[i], y[i]});
    return;
  }
  std::sort(keep.begin(), keep.end());
  const auto last = std::unique(keep.begin(), keep.end());
  for (auto index = keep.begin(); index != last; ++index) out.push_back({x[*index], y[*index]});
}

}  // namespace

std::vector<Point> thin(const std::vector<double>& x, const std::vector<double>& y, double low, double high,
                        int bins) {
  std::vector<Point> out;
  const std::size_t size = std::min(x.size(), y.size());
  if (size == 0 || !(high > low) || bins < 1) return out;
  const auto from = std::lower_bound(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(size), low);
  std::size_t i = static_cast<std::size_t>(from - x.begin());
  if (i > 0) --i;
  while (i < size) {
    const std::size_t begin = i;
    const double slice = std::floor((x[i] - low) / (high - low) * bins);
    const double slice_end = low + (slice + 1.0) * (high - low) / bins;
    while (i < size && x[i] < slice_end) ++i;
    if (i == begin) ++i;
    append_slice(out, x, y, begin, i);
    if (x[i - 1] > high) break;
  }
  return out;
}

std::vector<Point> straighten(const std::vector<Point>& points, double tolerance) {
  std::vector<Point> out;
  std::size_t anchor = 0;
  // Opening of slopes from the anchor that pass every point since within the tolerance.
  double least = -INFINITY, most = INFINITY;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (out.empty()) {
      out.push_back(points[i]);
      continue;
    }
    const double dx = points[i].x - points[anchor].x;
    const double dy = points[i].y - points[anchor].y;
    const bool fits = dx > 0.0 && dy / dx >= least && dy / dx <= most;
    if (!fits && i > anchor + 1) {
      anchor = i - 1;
      out.push_back(points[anchor]);
      least = -INFINITY;
      most = INFINITY;
    }
    const double run = points[i].x - points[anchor].x;
    const double rise = points[i].y - points[anchor].y;
    if (run > 0.0) {
      least = std::max(least, (rise - tolerance) / run);
      most = std::min(most, (rise + tolerance) / run);
    }
  }
  if (points.size() > 1) out.push_back(points.back());
  return out;
}

}  // namespace ironbird::scenarios::plot
