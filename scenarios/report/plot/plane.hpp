#pragma once

#include <string>
#include <vector>

#include "scenarios/report/plot/decimate.hpp"

namespace ironbird::scenarios::plot {

/// One curve in a plane.
struct Track {
  std::string name;
  std::string style;  ///< CSS classes, as for Series
  std::vector<Point> points;
};

/// A named place in a plane.
struct Place {
  std::string name;
  Point point;
};

/// A plane with the same scale on both axes, for example seen from above: x east, y north.
struct Plane {
  std::string title;
  std::string x_name;
  std::string y_name;
  std::string unit;
  std::vector<Track> tracks;
  std::vector<Place> places;
  std::string missing;   ///< said instead of curves when there are none
  double width = 560.0;  ///< px of the drawing's own coordinates
  double height = 560.0;
};

/// The drawing as an SVG element with an accessible title.
std::string draw(const Plane& plane);

/// What its tracks mean, as an HTML element.
std::string legend(const Plane& plane);

}  // namespace ironbird::scenarios::plot
