#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/report/plot/decimate.hpp"

namespace ironbird::scenarios::plot {

/// Text made safe for HTML, XML and attribute values.
std::string escaped(std::string_view text);

/// A coordinate with one decimal at most.
std::string coordinate(double value);

/// One attribute, with a leading space: ` name="value"`, escaped.
std::string attribute(std::string_view name, std::string_view value);
std::string attribute(std::string_view name, double value);

/// The `d` of a path through the points; a y that is no number lifts the pen.
std::string path_data(const std::vector<Point>& points);

std::string line(double x1, double y1, double x2, double y2, std::string_view css_class);
std::string text(double x, double y, std::string_view css_class, std::string_view content);
/// One line of a legend.
struct LegendEntry {
  std::string name;
  std::string style;  ///< CSS classes of the curve or strip
  bool is_strip = false;
  bool operator==(const LegendEntry&) const = default;
};

/// A legend as an HTML element that wraps; entries without a name are left out, equal ones are said once.
std::string legend(const std::vector<LegendEntry>& entries);

std::string rectangle(double x, double y, double width, double height, std::string_view css_class);

}  // namespace ironbird::scenarios::plot
