#include "scenarios/report/plot/axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace ironbird::scenarios::plot {

std::string Axis::label(double tick) const {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  std::array<char, 48> text{};
  const double shown = std::abs(tick) < step * 1e-6 ? 0.0 : tick;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, shown);
  std::string out = text.data();
  if (out.starts_with('-')) out.replace(0, 1, "\u2212");
  return out;
}

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  low = empty ? value : std::min(low, value);
  high = empty ? value : std::max(high, value);
  empty = false;
}

void Range::include(const std::vector<double>& values) {
  for (const double value : values) include(value);
}

double nice_step(double span, int most) {
  if (!(span > 0.0) || !std::isfinite(span)) return 1.0;
  const double rough = span / std::max(1, most);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  constexpr double kRoundOff = 1.0 + 1e-9;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (rough <= factor * power * kRoundOff) return factor * power;
  }
  return 10.0 * power;
}

Axis tight_axis(const Range& range, int most_ticks) {
  constexpr std::size_t kFewestTicks = 3;
  Axis axis{range.low, range.high, 1.0, {}};
  if (range.empty || !(range.high > range.low)) axis.high = axis.low + 1.0;
  const double span = axis.high - axis.low;
  for (int parts = most_ticks; axis.ticks.size() < kFewestTicks; parts *= 2) {
    axis.step = nice_step(span, parts);
    axis.ticks.clear();
    const double slack = axis.step * 1e-6;
    const double first = std::ceil((axis.low - slack) / axis.step);
    const double last = std::floor((axis.high + slack) / axis.step);
    for (double i = first; i <= last; i += 1.0) axis.ticks.push_back(i * axis.step);
  }
  return axis;
}

Axis roomy_axis(const Range& range, int most_ticks, double least_span) {
  constexpr double kAir = 0.06;  // of the span, at each end
  Range wide = range.empty ? Range{0.0, least_span, false} : range;
  const double span = std::max(wide.high - wide.low, least_span);
  const double centre = (wide.low + wide.high) / 2.0;
  wide.low = centre - span * (0.5 + kAir);
  wide.high = centre + span * (0.5 + kAir);
  return tight_axis(wide, most_ticks);
}

}  // namespace ironbird::scenarios::plot
