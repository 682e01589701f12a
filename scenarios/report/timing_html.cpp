#include "scenarios/report/timing_html.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scenarios/report/plot/svg.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kLeast = 1e-6;   // s, left edge of a histogram
constexpr double kDecades = 6.0;  // to 1 s
constexpr double kWidth = 240.0;
constexpr double kHeight = 28.0;

std::string milliseconds(double seconds) {
  return short_number(seconds * 1e3) + " ms";
}

double place_of(double seconds) {
  return std::clamp(std::log10(seconds / kLeast) / kDecades, 0.0, 1.0) * kWidth;
}

/// Bars over the logarithm of the duration; their height is the logarithm of the count, so that a single
/// outlier is seen beside a million.
std::string bars(const DurationCounts& stage) {
  constexpr double kBar = kWidth / (10.0 * kDecades);
  char text[160];
  std::snprintf(text, sizeof text,
                "<svg viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" role=\"img\">", kWidth,
                kHeight, kWidth, kHeight);
  std::string out = text;
  const double most = std::log10(1.0 + static_cast<double>(stage.count));
  for (std::size_t i = 0; i < stage.counts.size(); ++i) {
    const double height =
        kHeight * std::log10(1.0 + static_cast<double>(stage.counts[i])) / std::max(most, 1.0);
    const double right = std::isfinite(stage.up_to[i]) ? std::max(place_of(stage.up_to[i]), kBar) : kWidth;
    std::snprintf(text, sizeof text,
                  "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"currentColor\"/>",
                  right - kBar, kHeight - height, kBar - 0.5, height);
    out += text;
  }
  return out + "</svg>";
}

std::string row(const DurationCounts& stage) {
  return "<tr><td>" + plot::escaped(stage.name) + "</td><td>" + plot::escaped(stage.meaning) + "</td><td>" +
         std::to_string(stage.count) + "</td><td>" + milliseconds(stage.p50) + "</td><td>" +
         milliseconds(stage.p99) + "</td><td>" + milliseconds(stage.greatest) + "</td><td>" + bars(stage) +
         "</td></tr>";
}

}  // namespace

std::string timing_section(const ReportRun& run) {
  if (!run.verdict() || !run.verdict()->timing) return "";
  const BenchTiming& timing = *run.verdict()->timing;
  std::string out =
      "<section><h2>The bench's own time</h2><p>" + std::to_string(timing.passes) +
      " passes of the control loop; " + std::to_string(timing.missed) + " control periods missed, at most " +
      std::to_string(timing.most_missed) + " in a row; " + std::to_string(timing.page_faults) +
      " times its ticks waited for memory.</p><table><tr><th>stage</th><th>from when to "
      "when</th><th>count</th>"
      "<th>p50</th><th>p99</th><th>longest</th><th>1 us to 1 s, both axes logarithmic</th></tr>";
  for (const DurationCounts& stage : timing.stages) out += row(stage);
  return out + "</table></section>";
}

}  // namespace ironbird::scenarios
