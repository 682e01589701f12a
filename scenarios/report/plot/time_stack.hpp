#pragma once

#include <string>
#include <vector>

#include "scenarios/report/plot/axis.hpp"

namespace ironbird::scenarios::plot {

/// One curve over time.
struct Series {
  std::string name;
  std::string style;  ///< CSS classes: a colour `c0`…`c7`, and `dashed`, `dotted`, or `dots` without a line
  std::vector<double> time;
  std::vector<double> value;

  bool is_dots() const { return style.find("dots") != std::string::npos; }
};

/// A shaded strip between two curves over time, for example a 3-sigma bound.
struct Strip {
  std::string name;
  std::string style;
  std::vector<double> time;
  std::vector<double> low;
  std::vector<double> high;
};

/// One panel of a stack.
struct Panel {
  std::string title;  ///< what is drawn: "north"
  std::string unit;
  std::vector<Series> series;
  std::vector<Strip> strips;
  double least_span = 1e-3;         ///< in `unit`: quieter curves are not magnified further
  std::string missing;              ///< said instead of curves when there are none
  std::vector<Series> bounds = {};  ///< drawn where they are near the curves, which they do not flatten
};

/// A stretch of time in the background: a phase of flight.
struct Stretch {
  double from = 0.0;
  double to = 0.0;
  std::string name;
  std::string style;
};

/// A moment marked through all panels.
struct Mark {
  double time = 0.0;
  std::string name;   ///< in full
  std::string label;  ///< shown above the lane where there is room, else counted: "+2 more"
  std::string style;
};

/// What every stack of a page shares.
struct TimeFrame {
  Range range;
  std::vector<Stretch> stretches;
  std::vector<Mark> marks;
};

/// Panels above each other on one time axis.
struct TimeStack {
  std::string title;
  std::vector<Panel> panels;
  double width = 1120.0;        ///< px of the drawing's own coordinates
  double panel_height = 120.0;  ///< px
};

/// The drawing as an SVG element with an accessible title. It reads without a script; the page's script finds
/// the ranges in its data attributes and adds the cursor and the zoom.
std::string draw(const TimeStack& stack, const TimeFrame& frame);

/// How tall the drawing is, px of its own coordinates: the names of the marks take up to four rows.
double height(const TimeStack& stack, const TimeFrame& frame);

/// What its curves and strips mean, as an HTML element.
std::string legend(const TimeStack& stack);

}  // namespace ironbird::scenarios::plot
