#include "simulator/render/backdrop.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "simulator/render/ground_kernel.hpp"

namespace ironbird::simulator {
namespace {

const Vector3 kZenith(70.0, 126.0, 196.0);
const Vector3 kHorizon(206.0, 220.0, 230.0);
const Vector3 kFarHills(160.0, 182.0, 200.0);
const Vector3 kNearHills(128.0, 154.0, 152.0);
const Vector3 kLine(226.0, 232.0, 214.0);

constexpr double kHazeLength = 420.0;  // m, the ground's contrast falls to 1/e
constexpr double kLowestEye = 0.02;    // m above the ground
constexpr float kShadowDepth = 0.56F;  // share of the light that the sun brings
constexpr double kPeriod = 10.0;       // m, of everything that repeats on the ground

Pixel to_pixel(const Vector3& color) {
  return {static_cast<std::uint8_t>(color.x() + 0.5), static_cast<std::uint8_t>(color.y() + 0.5),
          static_cast<std::uint8_t>(color.z() + 0.5), 255};
}

Vector3 mix(const Vector3& a, const Vector3& b, double share) {
  return a + share * (b - a);
}

// Tangent of the hills' elevation at an azimuth: sums of waves with whole numbers of periods around the
// horizon.
double far_hills(double azimuth) {
  return 0.030 + 0.012 * std::sin(3.0 * azimuth + 0.7) + 0.008 * std::sin(7.0 * azimuth + 2.1) +
         0.004 * std::sin(17.0 * azimuth + 0.4) + 0.002 * std::sin(41.0 * azimuth);
}

double near_hills(double azimuth) {
  return 0.011 + 0.006 * std::sin(5.0 * azimuth + 4.0) + 0.004 * std::sin(11.0 * azimuth + 1.0) +
         0.002 * std::sin(29.0 * azimuth + 3.0) + 0.001 * std::sin(83.0 * azimuth);
}

// Opacity left to a pattern of `period`, m, when a pixel covers `footprint`, m: it fades out before it turns
// into noise.
float fade(double footprint, double period) {
  return static_cast<float>(std::clamp(1.6 - 1.8 * footprint / period, 0.0, 1.0));
}

}  // namespace

struct Backdrop::Row {
  double north = 0.0;
  double east = 0.0;
  double north_step = 0.0;
  double east_step = 0.0;
  double north_reach = 0.0;  // footprint of a pixel along the line of sight
  double east_reach = 0.0;
  double haze = 0.0;
};

Backdrop::Backdrop(const Vector3& ground_color, GroundMarks marks, bool quick_marks)
    : ground_color_(255.0 * ground_color), marks_(std::move(marks)), quick_marks_(quick_marks) {}

void Backdrop::draw(const Projection& projection, const std::vector<const ShadowMap*>& shadows,
                    Image& image) const {
  const int width = image.width();
  const double height = std::max(kLowestEye, -projection.p_N().z());
  const Vector3& down_N = projection.down_N();
  int horizon = 0;  // first row of the ground
  for (int y = 0; y < image.height(); ++y) {
    const Vector3 sight_N = projection.ray_N(projection.center_u(), y + 0.5);
    if (sight_N.z() < 1e-5) {
      horizon = y + 1;
      continue;
    }
    const double depth = height / sight_N.z();
    const Vector3 left_N = projection.ray_N(0.5, y + 0.5);
    const Vector3 reach_N = depth / projection.focal() * (down_N - down_N.z() / sight_N.z() * sight_N);
    Row row;
    row.north = projection.p_N().x() + depth * left_N.x();
    row.east = projection.p_N().y() + depth * left_N.y();
    row.north_step = depth / projection.focal() * projection.right_N().x();
    row.east_step = depth / projection.focal() * projection.right_N().y();
    row.north_reach = std::abs(reach_N.x());
    row.east_reach = std::abs(reach_N.y());
    row.haze = 1.0 - std::exp(-depth * sight_N.norm() / kHazeLength);
    Pixel* pixels = image.row(y);
    draw_ground_row(row, pixels, width);
    if (!marks_.empty()) {
      paint_marks(row, pixels, width);
    }
    for (const ShadowMap* shadow : shadows) {
      shade(row, *shadow, pixels, width);
    }
  }
  draw_sky(projection, horizon, image);
}

void Backdrop::draw_sky(const Projection& projection, int horizon, Image& image) const {
  const int width = image.width();
  for (int y = 0; y < horizon; ++y) {
    const Vector3 sight_N = projection.ray_N(projection.center_u(), y + 0.5);
    const double sine = std::max(0.0, -sight_N.z() / sight_N.norm());
    const Pixel color = to_pixel(mix(kHorizon, kZenith, 1.0 - std::exp(-3.2 * sine)));
    std::fill_n(image.row(y), width, color);
  }
  if (horizon == 0 || projection.down_N().z() < 0.2) {
    return;
  }
  const double level = -projection.forward_N().z() / projection.down_N().z();
  const double level_v = projection.center_v() + level * projection.focal();
  for (int x = 0; x < width; ++x) {
    const Vector3 ray_N = projection.ray_N(x + 0.5, level_v);
    const double azimuth = std::atan2(ray_N.y(), ray_N.x());
    const double scale = projection.focal() * ray_N.norm() / projection.down_N().z();
    const std::array<std::pair<double, Vector3>, 2> layers{
        {{far_hills(azimuth), kFarHills}, {near_hills(azimuth), kNearHills}}};
    for (const auto& [tangent, color] : layers) {
      const double top = level_v - tangent * scale;
      for (int y = std::max(0, static_cast<int>(top)); y < horizon; ++y) {
        const double depth = std::clamp((level_v - y) / (tangent * scale), 0.0, 1.0);
        const Vector3 hazy = mix(kHorizon, color, 0.35 + 0.65 * depth);
        const double cover = std::clamp(y + 1.0 - top, 0.0, 1.0);
        const Pixel below = image.at(x, y);
        image.at(x, y) = to_pixel(mix(Vector3(below.r, below.g, below.b), hazy, cover));
      }
    }
  }
}

void Backdrop::draw_ground_row(const Row& row, Pixel* pixels, int width) const {
  // All coordinates positive and small, so that single precision and truncation serve.
  const double last_north = row.north + row.north_step * width;
  const double last_east = row.east + row.east_step * width;
  const double north_base = kPeriod * (std::floor(std::min(row.north, last_north) / kPeriod) - 20.0);
  const double east_base = kPeriod * (std::floor(std::min(row.east, last_east) / kPeriod) - 20.0);
  const double north_print = std::abs(row.north_step) + row.north_reach;
  const double east_print = std::abs(row.east_step) + row.east_reach;
  const double print = std::max(north_print, east_print);
  const double clear = 1.0 - row.haze;
  GroundRow job;
  job.north = static_cast<float>(row.north - north_base);
  job.north_step = static_cast<float>(row.north_step);
  job.north_print = static_cast<float>(std::clamp(north_print, 1e-3, 150.0));
  job.east = static_cast<float>(row.east - east_base);
  job.east_step = static_cast<float>(row.east_step);
  job.east_print = static_cast<float>(std::clamp(east_print, 1e-3, 150.0));
  job.fine_lines = 0.42F * fade(print, 1.0);
  job.strong_lines = 0.70F * fade(print, 10.0);
  job.squares = fade(print, 10.0);
  for (int c = 0; c < 3; ++c) {
    job.base[c] = static_cast<float>(clear * ground_color_[c] + row.haze * kHorizon[c]);
    job.square[c] = static_cast<float>(clear * ground_color_[c] * 0.055);
    job.line[c] = static_cast<float>(clear * (kLine[c] - ground_color_[c]));
  }
  draw_ground(job, pixels, width);
}

void Backdrop::paint_marks(const Row& row, Pixel* pixels, int width) const {
  const Vector3& center_N = marks_.center_N();
  const double half = marks_.half_size();
  const auto first_last = row_range(row.north - center_N.x(), row.north_step, row.east - center_N.y(),
                                    row.east_step, half, width);
  const double lateral = std::hypot(row.north_step, row.east_step);
  const double reach = std::hypot(row.north_reach, row.east_reach);
  const int aslant = std::clamp(static_cast<int>(std::lround(reach / lateral)), 1, 3);
  const int samples = quick_marks_ ? 1 : aslant;
  const double across = quick_marks_ ? 2.0 * lateral : lateral;
  const GroundMarks::Sampler marks = marks_.sampler(static_cast<float>(std::max(across, reach / samples)));
  const float share = 1.0F / static_cast<float>(samples);
  const float haze = static_cast<float>(row.haze);
  const GroundMarks::Paint horizon(static_cast<float>(kHorizon.x()), static_cast<float>(kHorizon.y()),
                                   static_cast<float>(kHorizon.z()), 0.0F);
  // Samples spread along the line of sight, which on the ground is square to the row.
  const double north_side = lateral > 0.0 ? -row.east_step / lateral : 0.0;
  const double east_side = lateral > 0.0 ? row.north_step / lateral : 0.0;
  const auto paint_at = [&](int x) {
    GroundMarks::Paint paint = GroundMarks::Paint::Zero();
    for (int k = 0; k < samples; ++k) {
      const double along = reach * ((k + 0.5) / samples - 0.5);
      paint += marks(static_cast<float>(row.north + row.north_step * x + along * north_side),
                     static_cast<float>(row.east + row.east_step * x + along * east_side));
    }
    return GroundMarks::Paint(share * paint);
  };
  const auto put = [&](int x, const GroundMarks::Paint& paint) {
    const float opacity = paint[3];
    if (opacity == 0.0F) return;
    Pixel& p = pixels[x];
    const GroundMarks::Paint below = Eigen::Array4i(p.r, p.g, p.b, 0).cast<float>();
    const GroundMarks::Paint hazy = paint + (haze * (opacity * horizon - paint) + 0.5F);
    const Eigen::Array4i above = (below * (1.0F - opacity) + hazy).cast<int>();
    p.r = static_cast<std::uint8_t>(above[0]);
    p.g = static_cast<std::uint8_t>(above[1]);
    p.b = static_cast<std::uint8_t>(above[2]);
  };
  const auto [first, end] = first_last;
  if (!quick_marks_) {
    for (int x = first; x < end; ++x) put(x, paint_at(x));
    return;
  }
  // Every second pixel, the same ones in each row, and between two of them their mean.
  const int even = first - first % 2;
  GroundMarks::Paint paint = paint_at(even);
  for (int x = even; x < end; x += 2) {
    const GroundMarks::Paint next = paint_at(x + 2);
    if (x >= first) put(x, paint);
    if (x + 1 < end) put(x + 1, 0.5F * (paint + next));
    paint = next;
  }
}

void Backdrop::shade(const Row& row, const ShadowMap& shadow, Pixel* pixels, int width) {
  const double u = shadow.u(row.north, row.east);
  const double v = shadow.v(row.north, row.east);
  const double u_step = shadow.u(row.north + row.north_step, row.east + row.east_step) - u;
  const double v_step = shadow.v(row.north + row.north_step, row.east + row.east_step) - v;
  const double half = 0.5 * shadow.size();
  const auto first_last = row_range(u - half, u_step, v - half, v_step, half, width);
  const float depth = kShadowDepth * static_cast<float>(1.0 - row.haze);
  for (int x = first_last.first; x < first_last.second; ++x) {
    const float blocked =
        shadow.blocked(static_cast<float>(u + u_step * x), static_cast<float>(v + v_step * x));
    const float light = 1.0F - depth * blocked;
    Pixel& p = pixels[x];
    p.r = static_cast<std::uint8_t>(static_cast<float>(p.r) * light);
    p.g = static_cast<std::uint8_t>(static_cast<float>(p.g) * light);
    p.b = static_cast<std::uint8_t>(static_cast<float>(p.b) * (1.0F - 0.92F * depth * blocked));
  }
}

}  // namespace ironbird::simulator
