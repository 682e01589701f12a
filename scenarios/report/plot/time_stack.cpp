#include "scenarios/report/plot/time_stack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/report/plot/mark_names.hpp"
#include "scenarios/report/plot/svg.hpp"

namespace ironbird::scenarios::plot {

namespace {

constexpr double kLeft = 62.0;         // px: room for the numbers of the y axis
constexpr double kRight = 14.0;        // px
constexpr double kNear = 3.0;          // px: from a mark to its name
constexpr double kRow = 13.0;          // px: a row of names of marks, topmost
constexpr double kLane = 22.0;         // px: the lane of phases between the names and the first panel
constexpr double kCaption = 22.0;      // px: title and legend above each panel
constexpr double kBottom = 40.0;       // px: numbers and name of the time axis
constexpr double kThinPerPixel = 1.0;  // slices per pixel
constexpr double kTolerance = 0.12;    // px: what the eye does not see

/// Where a stack's parts lie, px.
struct Layout {
  const TimeStack& stack;
  Axis time;
  MarkNames names;

  double right() const { return stack.width - kRight; }
  double lane() const { return static_cast<double>(names.rows) * kRow; }
  /// Where the names of a row stand. @param row  0: next to the lane
  double baseline(std::size_t row) const { return lane() - static_cast<double>(row) * kRow - 4.0; }
  double top(std::size_t panel) const {
    return lane() + kLane + kCaption + static_cast<double>(panel) * (stack.panel_height + kCaption);
  }
  double bottom(std::size_t panel) const { return top(panel) + stack.panel_height; }
  double height() const { return bottom(stack.panels.size() - 1) + kBottom; }
  double x(double t) const { return kLeft + (t - time.low) / (time.high - time.low) * (right() - kLeft); }
};

Layout layout_of(const TimeStack& stack, const TimeFrame& frame) {
  const int ticks = static_cast<int>((stack.width - kLeft - kRight) / 70.0);
  Layout layout{stack, tight_axis(frame.range, std::max(2, ticks)), {}};
  std::vector<MarkName> wanted;
  for (const Mark& mark : frame.marks) {
    wanted.push_back({layout.x(mark.time), width_of(mark.label) + kNear, !mark.style.empty(), mark.label});
  }
  layout.names = placed(wanted, kLeft, stack.width);
  return layout;
}

/// The y axis of one panel.
struct Scale {
  Axis axis;
  double top = 0.0;
  double bottom = 0.0;
  double y(double value) const {
    return bottom - (value - axis.low) / (axis.high - axis.low) * (bottom - top);
  }
};

Axis value_axis(const Panel& panel, double panel_height) {
  Range range;
  for (const Series& series : panel.series) range.include(series.value);
  // A bound that is still wide open must not flatten the curve inside it.
  const double reach = std::max(4.0 * std::max(std::abs(range.low), std::abs(range.high)), panel.least_span);
  for (const Strip& strip : panel.strips) {
    for (const double high : strip.high) range.include(std::clamp(high, -reach, reach));
    for (const double low : strip.low) range.include(std::clamp(low, -reach, reach));
  }
  for (const Series& bound : panel.bounds) {
    for (const double value : bound.value) {
      if (std::abs(value) <= reach) range.include(value);
    }
  }
  return roomy_axis(range, std::max(2, static_cast<int>(panel_height / 26.0)), panel.least_span);
}

std::vector<Point> to_pixels(std::vector<Point> points, const Layout& layout, const Scale& scale) {
  for (Point& point : points) point = {layout.x(point.x), scale.y(point.y)};
  return points;
}

/// The curve in pixels, thinned; runs between gaps are straightened on their own.
std::string curve_data(const std::vector<double>& time, const std::vector<double>& value,
                       const Layout& layout, const Scale& scale) {
  const int bins = static_cast<int>((layout.right() - kLeft) * kThinPerPixel);
  const std::vector<Point> points =
      to_pixels(thin(time, value, layout.time.low, layout.time.high, bins), layout, scale);
  std::string out;
  std::vector<Point> run;
  for (const Point& point : points) {
    if (std::isfinite(point.y)) {
      run.push_back(point);
      continue;
    }
    out += path_data(straighten(run, kTolerance));
    run.clear();
  }
  return out + path_data(straighten(run, kTolerance));
}

/// A dot where there is a value: a line without length, whose ends are round.
std::string dots_data(const Series& series, const Layout& layout, const Scale& scale) {
  std::string out;
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    const Point at{layout.x(series.time[i]), scale.y(series.value[i])};
    if (std::isfinite(at.y)) out += path_data({at, at});
  }
  return out;
}

/// A bound, with gaps where it lies outside the panel.
std::string bound_data(const Series& bound, const Layout& layout, const Scale& scale) {
  std::vector<double> inside = bound.value;
  for (double& value : inside) {
    if (value < scale.axis.low || value > scale.axis.high) value = std::numeric_limits<double>::quiet_NaN();
  }
  return curve_data(bound.time, inside, layout, scale);
}

std::string path_of(const Series& series, const std::string& data) {
  return "<path class=\"curve " + escaped(series.style) + "\"" + attribute("data-name", series.name) +
         " d=\"" + data + "\"/>";
}

std::string strip_data(const Strip& strip, const Layout& layout, const Scale& scale) {
  const int bins = static_cast<int>((layout.right() - kLeft) / 4.0);
  std::vector<Point> edge, back;
  for (const Point& p :
       to_pixels(thin(strip.time, strip.high, layout.time.low, layout.time.high, bins), layout, scale)) {
    if (std::isfinite(p.y)) edge.push_back({p.x, std::clamp(p.y, scale.top, scale.bottom)});
  }
  for (const Point& p :
       to_pixels(thin(strip.time, strip.low, layout.time.low, layout.time.high, bins), layout, scale)) {
    if (std::isfinite(p.y)) back.push_back({p.x, std::clamp(p.y, scale.top, scale.bottom)});
  }
  if (edge.size() < 2 || back.size() < 2) return "";
  edge = straighten(edge, kTolerance);
  back = straighten(back, kTolerance);
  edge.insert(edge.end(), back.rbegin(), back.rend());
  return path_data(edge) + "Z";
}

/// Title and unit of a panel.
std::string caption(const Panel& panel, const Layout& layout, std::size_t index) {
  std::string out = "<text class=\"panel-title\" x=\"" + coordinate(kLeft) + "\" y=\"" +
                    coordinate(layout.top(index) - 7.0) + "\">" + escaped(panel.title);
  if (!panel.unit.empty()) out += "<tspan class=\"unit\">  " + escaped(panel.unit) + "</tspan>";
  return out + "</text>";
}

std::string grid(const Scale& scale, const Layout& layout) {
  std::string out = rectangle(kLeft, scale.top, layout.right() - kLeft, scale.bottom - scale.top, "frame");
  for (const double tick : scale.axis.ticks) {
    const double y = scale.y(tick);
    out += line(kLeft, y, layout.right(), y, std::abs(tick) < scale.axis.step * 1e-6 ? "grid zero" : "grid");
    out += text(kLeft - 7.0, y + 4.0, "number y", scale.axis.label(tick));
  }
  return out;
}

/// Stretches and marks behind the curves of a panel, in the group that zooms. Plain: marks only, so that a
/// strip keeps its colour.
std::string backdrop(const TimeFrame& frame, const Layout& layout, double top, double bottom, bool plain) {
  std::string out;
  for (const Stretch& stretch : plain ? std::vector<Stretch>() : frame.stretches) {
    const double from = layout.x(stretch.from), to = layout.x(stretch.to);
    out += rectangle(from, top, std::max(0.0, to - from), bottom - top, "phase " + stretch.style);
  }
  for (const Mark& mark : frame.marks) {
    out += line(layout.x(mark.time), top, layout.x(mark.time), bottom, "mark " + mark.style);
  }
  return out;
}

std::string draw_panel(const Panel& panel, const Layout& layout, std::size_t index, const TimeFrame& frame,
                       const std::string& clip) {
  const Scale scale{value_axis(panel, layout.stack.panel_height), layout.top(index), layout.bottom(index)};
  std::string out = "<g class=\"panel\"" + attribute("data-top", scale.top) +
                    attribute("data-bottom", scale.bottom) + attribute("data-low", scale.axis.low) +
                    attribute("data-high", scale.axis.high) + attribute("data-unit", panel.unit) + ">" +
                    caption(panel, layout, index);
  const bool is_empty = panel.series.empty() && panel.strips.empty();
  const std::string clipped = "<g clip-path=\"url(#" + clip + ")\"><g class=\"zoom\">";
  out += clipped + backdrop(frame, layout, scale.top, scale.bottom, !panel.strips.empty()) + "</g></g>";
  if (is_empty) {
    out += rectangle(kLeft, scale.top, layout.right() - kLeft, scale.bottom - scale.top, "frame");
    return out +
           text((kLeft + layout.right()) / 2.0, (scale.top + scale.bottom) / 2.0 + 4.0, "missing",
                panel.missing) +
           "</g>";
  }
  out += grid(scale, layout) + clipped;
  for (const Strip& strip : panel.strips) {
    out +=
        "<path class=\"strip " + escaped(strip.style) + "\" d=\"" + strip_data(strip, layout, scale) + "\"/>";
  }
  for (const Series& bound : panel.bounds) out += path_of(bound, bound_data(bound, layout, scale));
  for (const Series& series : panel.series) {
    out += path_of(series, series.is_dots() ? dots_data(series, layout, scale)
                                            : curve_data(series.time, series.value, layout, scale));
  }
  return out + "</g></g></g>";
}

/// What had no room, counted in the margin, with its names for who points at it.
std::string count_of_more(const std::vector<std::string>& names, double y) {
  if (names.empty()) return "";
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "no room for: " : ", ") + name;
  return "<text" + attribute("class", "more") + " x=\"" + coordinate(kLeft - 7.0) + "\" y=\"" +
         coordinate(y) + "\"><title>" + escaped(all) + "</title>+" + std::to_string(names.size()) +
         " more</text>";
}

std::string phase_names(const TimeFrame& frame, const Layout& layout) {
  std::string out = "<g class=\"phase-names\">";
  std::vector<std::string> unnamed;
  for (const Stretch& stretch : frame.stretches) {
    const double from = layout.x(stretch.from), to = layout.x(stretch.to);
    if (to - from > width_of(stretch.name) + 8.0) {
      out += text((from + to) / 2.0, layout.lane() + 12.5, "phase-name", stretch.name);
    } else {
      unnamed.push_back(stretch.name);
    }
  }
  return out + count_of_more(unnamed, layout.lane() + 12.5) + "</g>";
}

/// The lane above the panels: the phases, and a flag for each mark up to its name.
std::string lane(const TimeFrame& frame, const Layout& layout, const std::string& clip) {
  std::string out = "<g clip-path=\"url(#" + clip + ")\"><g class=\"zoom\">";
  for (const Stretch& stretch : frame.stretches) {
    const double from = layout.x(stretch.from), to = layout.x(stretch.to);
    out +=
        "<g>" +
        rectangle(from, layout.lane() + 1.0, std::max(0.0, to - from), 15.0, "phase-lane " + stretch.style) +
        "<title>" + escaped(stretch.name) + "</title></g>";
  }
  for (std::size_t i = 0; i < frame.marks.size(); ++i) {
    const Mark& mark = frame.marks[i];
    const double x = layout.x(mark.time);
    const auto& place = layout.names.places[i];
    const double from = place ? layout.baseline(place->row) - 9.0 : layout.lane();
    out += "<g>" + line(x, from, x, layout.lane() + kLane, "mark " + mark.style) + "<title>" +
           escaped(mark.name) + "</title></g>";
  }
  return out + "</g></g>";
}

std::string mark_names(const TimeFrame& frame, const Layout& layout) {
  std::string out = "<g class=\"mark-names\">";
  std::vector<std::string> unnamed;
  for (std::size_t i = 0; i < frame.marks.size(); ++i) {
    const Mark& mark = frame.marks[i];
    const auto& place = layout.names.places[i];
    if (!place) {
      if (!mark.label.empty()) unnamed.push_back(mark.label);
      continue;
    }
    const double x = layout.x(mark.time) + (place->before ? -kNear : kNear);
    out += text(x, layout.baseline(place->row), "mark-name " + mark.style + (place->before ? " before" : ""),
                mark.label);
  }
  return out + count_of_more(unnamed, layout.baseline(0)) + "</g>";
}

std::string time_axis(const Layout& layout) {
  const double bottom = layout.bottom(layout.stack.panels.size() - 1);
  std::string out = "<g class=\"time-axis\">";
  for (const double tick : layout.time.ticks) {
    const double x = layout.x(tick);
    for (std::size_t i = 0; i < layout.stack.panels.size(); ++i) {
      out += line(x, layout.top(i), x, layout.bottom(i), "grid");
    }
    out += text(x, bottom + 16.0, "number x", layout.time.label(tick));
  }
  return out + "</g>" + text((kLeft + layout.right()) / 2.0, bottom + 34.0, "axis-name", "time  s");
}

std::string clip_path(const std::string& id, const Layout& layout) {
  return "<clipPath id=\"" + id + "\"><rect x=\"" + coordinate(kLeft) + "\" y=\"0\" width=\"" +
         coordinate(layout.right() - kLeft) + "\" height=\"" + coordinate(layout.height()) +
         "\"/></clipPath>";
}

/// A name that is unique on a page as long as titles of one width are.
std::string clip_name(const std::string& title) {
  std::string id = "clip-";
  for (const char letter : title) {
    const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                       (letter >= '0' && letter <= '9');
    id += plain ? letter : '-';
  }
  return id;
}

}  // namespace

std::string legend(const TimeStack& stack) {
  std::vector<LegendEntry> entries;
  for (const Panel& panel : stack.panels) {
    for (const Series& series : panel.series) entries.push_back({series.name, series.style, false});
    for (const Series& bound : panel.bounds) entries.push_back({bound.name, bound.style, false});
    for (const Strip& strip : panel.strips) entries.push_back({strip.name, strip.style, true});
  }
  return legend(entries);
}

double height(const TimeStack& stack, const TimeFrame& frame) {
  return layout_of(stack, frame).height();
}

std::string draw(const TimeStack& stack, const TimeFrame& frame) {
  if (stack.panels.empty()) return "";
  const Layout layout = layout_of(stack, frame);
  const std::string clip = clip_name(stack.title + coordinate(stack.width));
  std::string out = "<svg class=\"time-stack\" role=\"img\" viewBox=\"0 0 " + coordinate(stack.width) + " " +
                    coordinate(layout.height()) + "\"" + attribute("aria-label", stack.title) +
                    attribute("data-left", kLeft) + attribute("data-right", layout.right()) +
                    attribute("data-from", layout.time.low) + attribute("data-to", layout.time.high) + ">";
  out += "<title>" + escaped(stack.title) + "</title><defs>" + clip_path(clip, layout) + "</defs>";
  out +=
      lane(frame, layout, clip) + phase_names(frame, layout) + mark_names(frame, layout) + time_axis(layout);
  for (std::size_t i = 0; i < stack.panels.size(); ++i)
    out += draw_panel(stack.panels[i], layout, i, frame, clip);
  return out + "</svg>";
}

}  // namespace ironbird::scenarios::plot
