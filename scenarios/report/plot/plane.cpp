#include "scenarios/report/plot/plane.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/report/plot/axis.hpp"
#include "scenarios/report/plot/svg.hpp"

namespace ironbird::scenarios::plot {

namespace {

constexpr double kPlaneLeft = 58.0;    // px: numbers and name of the y axis
constexpr double kPlaneRight = 16.0;   // px
constexpr double kTop = 10.0;          // px
constexpr double kPlaneBottom = 46.0;  // px: numbers and name of the x axis
constexpr double kNearer = 0.35;       // px: points closer than this to the one before are not drawn
constexpr double kLeastSpan = 1.0;     // in the plane's unit

/// Two axes of one scale, centred on what is drawn.
struct Frame {
  Axis x;
  Axis y;
  double left = kPlaneLeft, right = 0.0, top = kTop, bottom = 0.0;

  Point pixel(const Point& p) const {
    return {left + (p.x - x.low) / (x.high - x.low) * (right - left),
            bottom - (p.y - y.low) / (y.high - y.low) * (bottom - top)};
  }
};

Axis centred_axis(const Range& range, double span, int ticks) {
  const double centre = (range.low + range.high) / 2.0;
  return tight_axis({centre - span / 2.0, centre + span / 2.0, false}, ticks);
}

Frame frame_of(const Plane& plane) {
  Range x, y;
  for (const Track& track : plane.tracks) {
    for (const Point& point : track.points) {
      x.include(point.x);
      y.include(point.y);
    }
  }
  for (const Place& place : plane.places) {
    x.include(place.point.x);
    y.include(place.point.y);
  }
  Frame frame;
  frame.right = plane.width - kPlaneRight;
  frame.bottom = plane.height - kPlaneBottom;
  const double wide = frame.right - frame.left, tall = frame.bottom - frame.top;
  constexpr double kAir = 1.12;
  const double per_pixel =
      kAir * std::max({(x.high - x.low) / wide, (y.high - y.low) / tall, kLeastSpan / std::min(wide, tall)});
  const int ticks = static_cast<int>(std::min(wide, tall) / 60.0);
  frame.x = centred_axis(x, per_pixel * wide, ticks);
  frame.y = centred_axis(y, per_pixel * tall, ticks);
  // One step for both axes: equal squares.
  const Axis& coarse = frame.x.step > frame.y.step ? frame.x : frame.y;
  const double step = coarse.step;
  for (Axis* axis : {&frame.x, &frame.y}) {
    if (axis->step == step) continue;
    *axis = tight_axis({axis->low, axis->high, false},
                       std::max(1, static_cast<int>((axis->high - axis->low) / step)));
  }
  return frame;
}

std::string grid(const Frame& frame, const Plane& plane) {
  std::string out =
      rectangle(frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top, "frame");
  for (const double tick : frame.x.ticks) {
    const double x = frame.pixel({tick, frame.y.low}).x;
    out += line(x, frame.top, x, frame.bottom, "grid") +
           text(x, frame.bottom + 16.0, "number x", frame.x.label(tick));
  }
  for (const double tick : frame.y.ticks) {
    const double y = frame.pixel({frame.x.low, tick}).y;
    out += line(frame.left, y, frame.right, y, "grid") +
           text(frame.left - 7.0, y + 4.0, "number y", frame.y.label(tick));
  }
  const double middle = (frame.top + frame.bottom) / 2.0;
  out += text((frame.left + frame.right) / 2.0, frame.bottom + 36.0, "axis-name",
              plane.x_name + "  " + plane.unit);
  out += "<text class=\"axis-name\" transform=\"translate(14 " + coordinate(middle) + ") rotate(-90)\">" +
         escaped(plane.y_name + "  " + plane.unit) + "</text>";
  return out;
}

std::string track_data(const Track& track, const Frame& frame) {
  std::vector<Point> pixels;
  for (const Point& point : track.points) {
    const Point pixel = frame.pixel(point);
    const bool is_gap = !std::isfinite(pixel.x) || !std::isfinite(pixel.y);
    const bool is_near = !pixels.empty() && !is_gap &&
                         std::hypot(pixel.x - pixels.back().x, pixel.y - pixels.back().y) < kNearer;
    if (!is_near) pixels.push_back(pixel);
  }
  if (track.style.find("dots") == std::string::npos) return path_data(pixels);
  std::string dots;
  for (const Point& pixel : pixels) dots += path_data({pixel, pixel});
  return dots;
}

}  // namespace

std::string legend(const Plane& plane) {
  std::vector<LegendEntry> entries;
  for (const Track& track : plane.tracks) entries.push_back({track.name, track.style, false});
  return legend(entries);
}

std::string draw(const Plane& plane) {
  std::string out = "<svg class=\"plane\" role=\"img\" viewBox=\"0 0 " + coordinate(plane.width) + " " +
                    coordinate(plane.height) + "\"" + attribute("aria-label", plane.title) + "><title>" +
                    escaped(plane.title) + "</title>";
  const Frame frame = frame_of(plane);
  out += grid(frame, plane);
  if (plane.tracks.empty()) {
    return out + text(plane.width / 2.0, plane.height / 2.0, "missing", plane.missing) + "</svg>";
  }
  for (const Track& track : plane.tracks) {
    out += "<path class=\"curve " + escaped(track.style) + "\" d=\"" + track_data(track, frame) + "\"/>";
  }
  for (const Place& place : plane.places) {
    const Point at = frame.pixel(place.point);
    out += "<g class=\"place\"><circle cx=\"" + coordinate(at.x) + "\" cy=\"" + coordinate(at.y) +
           "\" r=\"9\"/>" + text(at.x, at.y + 4.0, "place-name", place.name) + "</g>";
  }
  return out + "</svg>";
}

}  // namespace ironbird::scenarios::plot
