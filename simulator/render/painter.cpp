#include "simulator/render/painter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace ironbird::simulator {
namespace {

constexpr double kHiddenOpacity = 0.22;  // of what stands behind a solid thing
constexpr double kNear = 2.0 * kNearPlane;

/// Without the care that std::hypot takes of overflow, for each pixel.
double pixels_apart(double du, double dv) {
  return std::sqrt(du * du + dv * dv);
}

void blend(Pixel& under, Pixel over, double opacity) {
  const auto mix = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(a + opacity * (b - a) + 0.5);
  };
  under.r = mix(under.r, over.r);
  under.g = mix(under.g, over.g);
  under.b = mix(under.b, over.b);
}

// First and last pixel of [low, high] within 0..size-1; empty when first > last.
std::pair<int, int> pixel_span(double low, double high, int size) {
  const double limit = size;
  return {static_cast<int>(std::clamp(std::floor(low), 0.0, limit)),
          static_cast<int>(std::clamp(std::ceil(high), -1.0, limit - 1.0))};
}

}  // namespace

Painter::Painter(Image& image, const DepthImage& depth, const Projection& projection)
    : image_(image), depth_(depth), projection_(projection) {}

void Painter::line(const Vector3& a_N, const Vector3& b_N, double width, Pixel color, double opacity) {
  Vector3 a = a_N;
  Vector3 b = b_N;
  const double a_depth = projection_.forward_N().dot(a - projection_.p_N());
  const double b_depth = projection_.forward_N().dot(b - projection_.p_N());
  if (a_depth < kNear && b_depth < kNear) {
    return;
  }
  if (a_depth < kNear) {
    a = b + (a - b) * ((b_depth - kNear) / (b_depth - a_depth));
  } else if (b_depth < kNear) {
    b = a + (b - a) * ((a_depth - kNear) / (a_depth - b_depth));
  }
  const std::optional<ScreenPoint> from = projection_.project(a);
  const std::optional<ScreenPoint> to = projection_.project(b);
  if (from && to) {
    segment(from->u, from->v, from->depth, to->u, to->v, to->depth, width, color, opacity);
  }
}

void Painter::segment(double au, double av, double ad, double bu, double bv, double bd, double width,
                      Pixel color, double opacity) {
  const double reach = 0.5 * width + 0.5;
  const double du = bu - au;
  const double dv = bv - av;
  const double square = std::max(du * du + dv * dv, 1e-12);
  const double slope = std::abs(dv) > 1e-9 ? du / dv : 0.0;
  const double slack = reach * std::sqrt(square) / std::max(std::abs(dv), 1e-9);
  const auto rows = pixel_span(std::min(av, bv) - reach, std::max(av, bv) + reach, image_.height());
  for (int y = rows.first; y <= rows.second; ++y) {
    // Columns near the line in this row, and never beyond its ends.
    const double u = au + slope * (y + 0.5 - av);
    const bool flat = std::abs(dv) < 1e-9;
    const auto columns =
        pixel_span(std::max(std::min(au, bu) - reach, flat ? -1e9 : u - slack - 1.0),
                   std::min(std::max(au, bu) + reach, flat ? 1e9 : u + slack + 1.0), image_.width());
    for (int x = columns.first; x <= columns.second; ++x) {
      const double along = ((x + 0.5 - au) * du + (y + 0.5 - av) * dv) / square;
      const double k = std::clamp(along, 0.0, 1.0);
      const double distance = pixels_apart(x + 0.5 - au - k * du, y + 0.5 - av - k * dv);
      const double cover = std::clamp(reach - distance, 0.0, 1.0) * (along < 0.0 || along >= 1.0 ? 0.5 : 1.0);
      if (cover > 0.0) {
        const double depth = 1.0 / ((1.0 - k) / ad + k / bd);
        const double seen = depth < depth_.at(x, y) + 0.02 ? 1.0 : kHiddenOpacity;
        blend(image_.at(x, y), color, opacity * cover * seen);
      }
    }
  }
}

void Painter::path(const std::vector<Vector3>& points_N, double width, Pixel color, double opacity,
                   double dash) {
  double along = 0.0;
  for (std::size_t i = 1; i < points_N.size(); ++i) {
    const Vector3& a = points_N[i - 1];
    const Vector3 step = points_N[i] - a;
    const double length = step.norm();
    if (length < 1e-9) {
      continue;
    }
    if (dash <= 0.0) {
      line(a, points_N[i], width, color, opacity);
      continue;
    }
    double begin = 0.0;
    while (begin < length) {
      const double phase = std::fmod(along + begin, 2.0 * dash);
      const bool ink = phase < dash;
      const double end = std::min(length, begin + (ink ? dash - phase : 2.0 * dash - phase) + 1e-9);
      if (ink) {
        line(a + begin / length * step, a + end / length * step, width, color, opacity);
      }
      begin = end;
    }
    along += length;
  }
}

void Painter::ring(const Vector3& center_N, double radius, double width, Pixel color, double opacity) {
  constexpr int kCorners = 40;
  const auto corner = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    return Vector3(center_N + radius * Vector3(std::cos(angle), std::sin(angle), 0.0));
  };
  for (int i = 0; i < kCorners; ++i) {
    line(corner(i), corner(i + 1), width, color, opacity);
  }
}

void Painter::plate(const Vector3& center_N, double radius_px, Pixel fill, Pixel rim, double opacity,
                    std::string_view label, const GlyphAtlas& letters) {
  const std::optional<ScreenPoint> center = projection_.project(center_N);
  if (!center) {
    return;
  }
  const auto rows = pixel_span(center->v - radius_px - 1.0, center->v + radius_px + 1.0, image_.height());
  const auto columns = pixel_span(center->u - radius_px - 1.0, center->u + radius_px + 1.0, image_.width());
  for (int y = rows.first; y <= rows.second; ++y) {
    for (int x = columns.first; x <= columns.second; ++x) {
      const double r = pixels_apart(x + 0.5 - center->u, y + 0.5 - center->v);
      const double cover = std::clamp(radius_px + 0.5 - r, 0.0, 1.0);
      const double inner = std::clamp(radius_px - 1.7 - r, 0.0, 1.0);
      const double seen = center->depth < depth_.at(x, y) + 0.02 ? opacity : opacity * kHiddenOpacity;
      Pixel color = rim;
      blend(color, fill, inner);
      blend(image_.at(x, y), color, cover * seen);
    }
  }
  const int left = static_cast<int>(std::lround(center->u - 0.5 * letters.text_width(label)));
  const int baseline = static_cast<int>(std::lround(center->v + 0.5 * letters.cap_height()));
  text(left, baseline, label, rim, letters, center->depth, opacity);
}

void Painter::halo(const Vector3& center_N, double radius_px, double width, Pixel color, double opacity) {
  const std::optional<ScreenPoint> center = projection_.project(center_N);
  if (!center) {
    return;
  }
  const double reach = radius_px + 0.5 * width + 1.0;
  const auto rows = pixel_span(center->v - reach, center->v + reach, image_.height());
  const auto columns = pixel_span(center->u - reach, center->u + reach, image_.width());
  for (int y = rows.first; y <= rows.second; ++y) {
    for (int x = columns.first; x <= columns.second; ++x) {
      const double r = pixels_apart(x + 0.5 - center->u, y + 0.5 - center->v);
      const double cover = std::clamp(0.5 * width + 0.5 - std::abs(r - radius_px), 0.0, 1.0);
      if (cover > 0.0) {
        blend(image_.at(x, y), color, opacity * cover);
      }
    }
  }
}

void Painter::rotor(const Vector3& center_N, const Vector3& axis_N, const Vector3& blade_N, double radius) {
  const std::optional<ScreenPoint> center = projection_.project(center_N);
  if (!center || center->depth < radius + kNear) {
    return;
  }
  const double reach = projection_.focal() * radius / (center->depth - radius) * 1.3 + 2.0;
  const auto rows = pixel_span(center->v - reach, center->v + reach, image_.height());
  const auto columns = pixel_span(center->u - reach, center->u + reach, image_.width());
  const Vector3 side_N = axis_N.cross(blade_N);
  const double offset = axis_N.dot(center_N - projection_.p_N());
  const double pixel = center->depth / projection_.focal();
  for (int y = rows.first; y <= rows.second; ++y) {
    for (int x = columns.first; x <= columns.second; ++x) {
      const Vector3 ray_N = projection_.ray_N(x + 0.5, y + 0.5);
      const double facing = axis_N.dot(ray_N);
      const double depth = offset / (std::abs(facing) < 1e-6 ? 1e-6 : facing);
      if (depth < kNear || depth > depth_.at(x, y)) {
        continue;
      }
      const Vector3 r_N = projection_.p_N() + depth * ray_N - center_N;
      const double r = r_N.norm();
      const double edge =
          std::clamp((radius - r) / (pixel / std::max(0.15, std::abs(facing))) + 0.5, 0.0, 1.0);
      if (edge <= 0.0) {
        continue;
      }
      const double along = r > 1e-9 ? blade_N.dot(r_N) / r : 0.0;
      const double across = r > 1e-9 ? side_N.dot(r_N) / r : 0.0;
      const double square = along * along;
      const double lobe = square * square * square * square * square * (0.75 + 0.25 * along * across);
      const bool tip = r > 0.88 * radius;
      const Pixel color = tip ? Pixel{232, 232, 224, 255} : Pixel{34, 36, 40, 255};
      // Seen flat a disc is denser: more of it lies in the line of sight.
      const double dense = 1.0 / (0.45 + 0.55 * std::min(1.0, std::abs(facing)));
      blend(image_.at(x, y), color, std::min(0.8, edge * dense * ((tip ? 0.20 : 0.15) + 0.34 * lobe)));
    }
  }
}

void Painter::text(int left, int baseline, std::string_view text, Pixel color, const GlyphAtlas& letters,
                   double depth, double opacity) {
  int pen = left - letters.left_bearing();
  const int top = baseline - letters.baseline();
  for (const char character : text) {
    const GlyphAtlas::Glyph& glyph = letters.glyph(character);
    for (int y = std::max(0, -top); y < std::min(letters.height(), image_.height() - top); ++y) {
      for (int x = std::max(0, -pen); x < std::min(glyph.width, image_.width() - pen); ++x) {
        const std::uint8_t cover = glyph.coverage[static_cast<std::size_t>(y * glyph.width + x)];
        if (cover > 0) {
          const double seen = depth < depth_.at(pen + x, top + y) + 0.02 ? 1.0 : kHiddenOpacity;
          blend(image_.at(pen + x, top + y), color, opacity * seen * cover / 255.0);
        }
      }
    }
    pen += glyph.advance;
  }
}

void Painter::shade(int left, int top, int right, int bottom, double opacity) {
  for (int y = std::max(0, top); y < std::min(bottom, image_.height()); ++y) {
    for (int x = std::max(0, left); x < std::min(right, image_.width()); ++x) {
      blend(image_.at(x, y), Pixel{14, 20, 28, 255}, opacity);
    }
  }
}

}  // namespace ironbird::simulator
