#include "scenarios/report/plot/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace ironbird::scenarios::plot {

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char letter : text) {
    switch (letter) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:  // control characters are not allowed in XML
        out += static_cast<unsigned char>(letter) < 0x20 && letter != '\n' && letter != '\t' ? ' ' : letter;
    }
  }
  return out;
}

std::string coordinate(double value) {
  std::array<char, 48> text{};
  const double rounded = std::round(value * 10.0) / 10.0;
  std::snprintf(text.data(), text.size(), "%.1f", rounded == 0.0 ? 0.0 : rounded);
  std::string out = text.data();
  if (out.ends_with(".0")) out.resize(out.size() - 2);
  return out;
}

std::string attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

std::string attribute(std::string_view name, double value) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return attribute(name, std::string_view(text.data()));
}

std::string path_data(const std::vector<Point>& points) {
  std::string out;
  bool pen_down = false;
  for (const Point& point : points) {
    if (!std::isfinite(point.y) || !std::isfinite(point.x)) {
      pen_down = false;
      continue;
    }
    out += pen_down ? " " : "M";
    out += coordinate(point.x) + "," + coordinate(point.y);
    pen_down = true;
  }
  return out;
}

std::string line(double x1, double y1, double x2, double y2, std::string_view css_class) {
  return "<line" + attribute("class", css_class) + " x1=\"" + coordinate(x1) + "\" y1=\"" + coordinate(y1) +
         "\" x2=\"" + coordinate(x2) + "\" y2=\"" + coordinate(y2) + "\"/>";
}

std::string text(double x, double y, std::string_view css_class, std::string_view content) {
  return "<text" + attribute("class", css_class) + " x=\"" + coordinate(x) + "\" y=\"" + coordinate(y) +
         "\">" + escaped(content) + "</text>";
}

std::string rectangle(double x, double y, double width, double height, std::string_view css_class) {
  return "<rect" + attribute("class", css_class) + " x=\"" + coordinate(x) + "\" y=\"" + coordinate(y) +
         "\" width=\"" + coordinate(width) + "\" height=\"" + coordinate(height) + "\"/>";
}

std::string legend(const std::vector<LegendEntry>& entries) {
  std::string out = "<div class=\"legend\">";
  std::vector<LegendEntry> said;
  for (const LegendEntry& entry : entries) {
    if (entry.name.empty() || std::find(said.begin(), said.end(), entry) != said.end()) continue;
    said.push_back(entry);
    const bool is_dots = entry.style.find("dots") != std::string::npos;
    out += "<span><svg width=\"22\" height=\"10\" aria-hidden=\"true\">" +
           (entry.is_strip ? rectangle(0.0, 0.0, 22.0, 10.0, "strip " + entry.style)
            : is_dots      ? line(11.0, 5.0, 11.0, 5.0, "curve " + entry.style)
                           : line(0.0, 5.0, 22.0, 5.0, "curve " + entry.style)) +
           "</svg>" + escaped(entry.name) + "</span>";
  }
  return out + "</div>";
}

}  // namespace ironbird::scenarios::plot
