#include "simulator/render/scene_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulator/render/backdrop.hpp"
#include "simulator/render/glyph_atlas.hpp"
#include "simulator/render/ground_marks.hpp"
#include "simulator/render/painter.hpp"
#include "simulator/render/shadow_map.hpp"
#include "simulator/render/solid_layer.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kBlurSpeed = 40.0;    // rad/s, above it a rotor is a disc
constexpr float kNothing = 1e9F;       // m, depth where there is nothing solid
constexpr double kGhostBegins = 0.05;  // m between truth and estimate, from where the ghost shows
constexpr double kGhostFull = 0.40;    // m

constexpr double kSmallVehicle = 20.0;  // px at 720 rows: a vehicle of a smaller radius is ringed
constexpr double kPlate = 14.0;         // px at 720 rows: radius of a waypoint's plate
constexpr double kMark = 3.5;           // px at 720 rows: radius of a small mark
constexpr double kFaintPlate = 0.15;    // of its opacity that a plate keeps where the vehicle is
constexpr double kHalo = 20.0;          // px at 720 rows, just outside a waypoint's plate

constexpr Pixel kPathColor{255, 255, 255, 255};
constexpr Pixel kTrailColor{255, 132, 28, 255};
constexpr Pixel kGhostColor{40, 214, 255, 255};
constexpr Pixel kMarkColor{250, 214, 40, 255};
constexpr Pixel kPlateColor{24, 78, 152, 255};
constexpr Pixel kReachedColor{38, 128, 78, 255};
constexpr Pixel kTextColor{240, 244, 248, 255};

int samples_per_axis(Quality quality) {
  return quality == Quality::kPreview ? 1 : quality == Quality::kFilm ? 2 : 3;
}

void check(const char* name, int value, int least, int greatest) {
  if (value < least || value > greatest) {
    throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) + " px, must be " +
                                std::to_string(least) + ".." + std::to_string(greatest));
  }
}

// Sizes in proportion to the picture, 1 at 720 rows.
double scale_of(const RendererParams& params) {
  return params.height / 720.0;
}

// Covers a part of the picture with what a layer drew there.
void cover(const SolidPicture& solid, Image& image, DepthImage& depth) {
  const int n = solid.samples;
  const int columns = solid.rect.width() * n;
  const int all = n * n;
  for (int y = 0; y < solid.rect.height(); ++y) {
    Pixel* out = image.row(solid.rect.top + y) + solid.rect.left;
    float* out_depth =
        depth.depth.data() + static_cast<std::ptrdiff_t>(solid.rect.top + y) * depth.width + solid.rect.left;
    const std::ptrdiff_t lowest = static_cast<std::ptrdiff_t>(solid.rect.height() - 1 - y) * n * columns;
    for (int x = 0; x < solid.rect.width(); ++x) {
      int hits = 0;
      std::array<int, 3> sum{};
      float nearest = 1.0F;
      for (int j = 0; j < n; ++j) {
        const std::ptrdiff_t first = lowest + static_cast<std::ptrdiff_t>(j) * columns + x * n;
        for (std::ptrdiff_t at = first; at < first + n; ++at) {
          const float window = solid.window_depth[static_cast<std::size_t>(at)];
          if (window < 1.0F) {
            const std::uint8_t* color = solid.rgba.data() + 4 * at;
            ++hits;
            sum[0] += color[0];
            sum[1] += color[1];
            sum[2] += color[2];
            nearest = std::min(nearest, window);
          }
        }
      }
      if (hits > 0) {
        out_depth[x] = std::min(out_depth[x], solid.depth(nearest));
        out[x].r = static_cast<std::uint8_t>((sum[0] + (all - hits) * out[x].r) / all);
        out[x].g = static_cast<std::uint8_t>((sum[1] + (all - hits) * out[x].g) / all);
        out[x].b = static_cast<std::uint8_t>((sum[2] + (all - hits) * out[x].b) / all);
      }
    }
  }
}

// Lays a tinted, even veil where a layer drew something in front of what is already there.
void veil(const SolidPicture& solid, Pixel tint, double opacity, Image& image, const DepthImage& depth) {
  const int columns = solid.rect.width();
  for (int y = 0; y < solid.rect.height(); ++y) {
    for (int x = 0; x < columns; ++x) {
      const auto at = static_cast<std::size_t>((solid.rect.height() - 1 - y) * columns + x);
      const int px = solid.rect.left + x;
      const int py = solid.rect.top + y;
      if (solid.window_depth[at] >= 1.0F || solid.depth(solid.window_depth[at]) > depth.at(px, py)) {
        continue;
      }
      const std::uint8_t* color = solid.rgba.data() + 4 * at;
      const double light = 0.45 + 0.55 * (color[0] + color[1] + color[2]) / 765.0;
      Pixel& out = image.at(px, py);
      out.r = static_cast<std::uint8_t>(out.r + opacity * (tint.r * light - out.r));
      out.g = static_cast<std::uint8_t>(out.g + opacity * (tint.g * light - out.g));
      out.b = static_cast<std::uint8_t>(out.b + opacity * (tint.b * light - out.b));
    }
  }
}

}  // namespace

struct SceneRenderer::Parts {
  RendererParams params;
  int samples;
  double scale;
  SolidLayer solids;
  GlyphAtlas letters;
  GlyphAtlas small_letters;
  Backdrop backdrop;
  ShadowMap field_shadow;
  DepthImage depth;

  explicit Parts(const RendererParams& p)
      : params(p),
        samples(samples_per_axis(p.quality)),
        scale(scale_of(p)),
        solids(p.vehicle_scene, p.field_scene, std::max(1024, p.width * samples),
               std::max(1024, p.height * samples)),
        letters(solids, std::max(5, static_cast<int>(std::lround(17.0 * scale)))),
        small_letters(solids, std::max(5, static_cast<int>(std::lround(13.0 * scale)))),
        backdrop(solids.ground_color(),
                 GroundMarks(solids.helipad(), solids.compass_rose(), GlyphAtlas(solids, 40)),
                 p.quality == Quality::kPreview) {
    if (solids.obstacles().radius > 0.0) {
      solids.pose(RenderSample{}, kBlurSpeed);
      field_shadow =
          ShadowMap(solids, SolidPart::kField, solids.obstacles().p_N, solids.obstacles().radius, 1024);
    }
    depth.width = params.width;
  }

  ShadowMap vehicle_shadow(const RenderSample& sample);
  void draw_solids(const Projection& projection, Image& image);
  void draw_rotors(const RenderSample& sample, Painter& painter) const;
  void draw_ghost(const RenderSample& sample, const Pose& estimate, const Projection& projection,
                  Image& image);
  void draw_route(const RenderSample& sample, const Overlays& overlays, const Projection& projection,
                  Painter& painter) const;
  void draw_trail(const std::vector<Vector3>& points_N, Pixel color, Painter& painter) const;
  std::optional<ScreenPoint> small_vehicle(const RenderSample& sample, const Projection& projection) const;
  double clearance(const WaypointMark& mark, const std::optional<ScreenPoint>& vehicle,
                   const Projection& projection) const;
  void draw_text(const Overlays& overlays, Painter& painter) const;
  void draw_halo(const RenderSample& sample, const Overlays& overlays, const Projection& projection,
                 Painter& painter) const;
};

ShadowMap SceneRenderer::Parts::vehicle_shadow(const RenderSample& sample) {
  const int size = params.quality == Quality::kStill ? 512 : params.quality == Quality::kFilm ? 160 : 96;
  const Pose& pose = sample.pose;
  ShadowMap shadow(solids, SolidPart::kVehicle, pose.p_NB_N, 1.1 * solids.vehicle_radius(), size);
  for (std::size_t i = 0; i < solids.rotors().size(); ++i) {
    if (std::abs(sample.rotor_speed[i]) > kBlurSpeed) {
      shadow.add_disc(pose.p_NB_N + pose.q_NB * solids.rotors()[i].p_B, pose.q_NB * Vector3::UnitZ(),
                      solids.rotors()[i].radius, 0.30);
    }
  }
  return shadow;
}

void SceneRenderer::Parts::draw_solids(const Projection& projection, Image& image) {
  depth.depth.assign(static_cast<std::size_t>(params.width) * static_cast<std::size_t>(params.height),
                     kNothing);
  const PixelRect rect = solids.bounds(projection, SolidPart::kEverything);
  if (!rect.empty()) {
    cover(solids.draw(projection, rect, samples, SolidPart::kEverything), image, depth);
  }
}

void SceneRenderer::Parts::draw_rotors(const RenderSample& sample, Painter& painter) const {
  const Pose& pose = sample.pose;
  for (std::size_t i = 0; i < solids.rotors().size(); ++i) {
    if (std::abs(sample.rotor_speed[i]) > kBlurSpeed) {
      // The angle counts about the upward axis: from above, counter-clockwise.
      const double angle = -sample.rotor_angle[i];
      const Vector3 blade_B(std::cos(angle), std::sin(angle), 0.0);
      painter.rotor(pose.p_NB_N + pose.q_NB * solids.rotors()[i].p_B, pose.q_NB * Vector3::UnitZ(),
                    pose.q_NB * blade_B, solids.rotors()[i].radius);
    }
  }
}

void SceneRenderer::Parts::draw_ghost(const RenderSample& sample, const Pose& estimate,
                                      const Projection& projection, Image& image) {
  const double apart =
      (estimate.p_NB_N - sample.pose.p_NB_N).norm() + 0.5 * estimate.q_NB.angularDistance(sample.pose.q_NB);
  const double share = std::clamp((apart - kGhostBegins) / (kGhostFull - kGhostBegins), 0.0, 1.0);
  if (!(share > 0.0)) {
    return;
  }
  RenderSample ghost = sample;
  ghost.pose = estimate;
  solids.pose(ghost, kBlurSpeed);
  const PixelRect rect = solids.bounds(projection, SolidPart::kVehicle);
  if (!rect.empty()) {
    veil(solids.draw(projection, rect, 1, SolidPart::kVehicle), kGhostColor, 0.55 * share, image, depth);
  }
}

/// Where the vehicle is in the picture when it is so small that a waypoint's plate would hide it.
std::optional<ScreenPoint> SceneRenderer::Parts::small_vehicle(const RenderSample& sample,
                                                               const Projection& projection) const {
  const std::optional<ScreenPoint> center = projection.project(sample.pose.p_NB_N);
  const bool is_small =
      center && projection.focal() * solids.vehicle_radius() / center->depth <= kSmallVehicle * scale;
  return is_small ? center : std::nullopt;
}

void SceneRenderer::Parts::draw_route(const RenderSample& sample, const Overlays& overlays,
                                      const Projection& projection, Painter& painter) const {
  const std::optional<ScreenPoint> vehicle = small_vehicle(sample, projection);
  painter.path(overlays.planned_path_N, 2.0 * scale, kPathColor, 0.85, 0.5);
  draw_trail(overlays.ghost_trail_N, kGhostColor, painter);
  draw_trail(overlays.trail_N, kTrailColor, painter);
  for (const Vector3& mark_N : overlays.marks_N) {
    painter.plate(mark_N, kMark * scale, kMarkColor, kMarkColor, 0.9, "", small_letters);
  }
  for (const WaypointMark& mark : overlays.waypoints) {
    const Pixel color = mark.reached ? kReachedColor : kPlateColor;
    const Vector3 foot_N(mark.p_N.x(), mark.p_N.y(), 0.0);
    painter.line(foot_N, mark.p_N, 1.4 * scale, kPathColor, 0.55);
    painter.ring(foot_N, 0.35, 1.6 * scale, kPathColor, 0.75);
    const double opacity = (mark.reached ? 0.75 : 0.95) * clearance(mark, vehicle, projection);
    painter.plate(mark.p_N, kPlate * scale, color, kTextColor, opacity, mark.label, small_letters);
  }
}

/// A trail that fades towards its oldest point.
void SceneRenderer::Parts::draw_trail(const std::vector<Vector3>& points_N, Pixel color,
                                      Painter& painter) const {
  const std::size_t count = points_N.size();
  for (std::size_t i = 1; i < count; ++i) {
    const double age = static_cast<double>(count - i) / static_cast<double>(count);
    painter.line(points_N[i - 1], points_N[i], 2.6 * scale, color, 0.9 - 0.65 * age);
  }
}

/// How much of a plate to show, 0..1: little of one that the small vehicle flies behind or in front of.
double SceneRenderer::Parts::clearance(const WaypointMark& mark, const std::optional<ScreenPoint>& vehicle,
                                       const Projection& projection) const {
  const std::optional<ScreenPoint> plate = projection.project(mark.p_N);
  if (!plate || !vehicle) {
    return 1.0;
  }
  const double apart = std::hypot(plate->u - vehicle->u, plate->v - vehicle->v) / scale;
  return std::clamp((apart - kPlate) / kHalo, kFaintPlate, 1.0);
}

/// From far away the vehicle is a few dark pixels: say where it is. Not in a picture without overlays, which
/// is to show the scene alone.
void SceneRenderer::Parts::draw_halo(const RenderSample& sample, const Overlays& overlays,
                                     const Projection& projection, Painter& painter) const {
  const bool has_overlays = !overlays.trail_N.empty() || !overlays.waypoints.empty();
  if (!has_overlays || !small_vehicle(sample, projection)) {
    return;
  }
  painter.halo(sample.pose.p_NB_N, kHalo * scale, 4.4 * scale, kTextColor, 0.5);
  painter.halo(sample.pose.p_NB_N, kHalo * scale, 2.4 * scale, kTrailColor, 1.0);
}

void SceneRenderer::Parts::draw_text(const Overlays& overlays, Painter& painter) const {
  if (overlays.title.empty() && overlays.captions.empty()) {
    return;
  }
  const int margin = static_cast<int>(18.0 * scale);
  const int pad = static_cast<int>(12.0 * scale);
  const int title = overlays.title.empty() ? 0 : letters.cap_height() + pad;
  const int line = small_letters.cap_height() + static_cast<int>(10.0 * scale);
  int width = letters.text_width(overlays.title);
  for (const std::string& caption : overlays.captions) {
    width = std::max(width, small_letters.text_width(caption));
  }
  const int height = title + line * static_cast<int>(overlays.captions.size());
  painter.shade(margin, margin, margin + width + 2 * pad, margin + height + pad, 0.58);
  painter.text(margin + pad, margin + pad + letters.cap_height(), overlays.title, kTextColor, letters);
  int baseline = margin + title + small_letters.cap_height() + pad - (overlays.title.empty() ? 0 : 2);
  for (const std::string& caption : overlays.captions) {
    painter.text(margin + pad, baseline, caption, kTextColor, small_letters);
    baseline += line;
  }
}

SceneRenderer::SceneRenderer(const RendererParams& params) {
  check("width", params.width, 16, 3840);
  check("height", params.height, 16, 2160);
  parts_ = std::make_unique<Parts>(params);
}

SceneRenderer::~SceneRenderer() = default;

Image SceneRenderer::render(const RenderSample& sample, const Camera& camera, const Overlays& overlays) {
  Parts& parts = *parts_;
  const Projection projection(camera, parts.params.width, parts.params.height);
  Image image(parts.params.width, parts.params.height);
  parts.solids.pose(sample, kBlurSpeed);
  const ShadowMap shadow = parts.vehicle_shadow(sample);
  std::vector<const ShadowMap*> shadows{&shadow};
  if (!parts.field_shadow.empty()) {
    shadows.push_back(&parts.field_shadow);
  }
  parts.backdrop.draw(projection, shadows, image);
  parts.draw_solids(projection, image);
  Painter painter(image, parts.depth, projection);
  parts.draw_route(sample, overlays, projection, painter);
  parts.draw_rotors(sample, painter);
  if (overlays.estimate) {
    parts.draw_ghost(sample, *overlays.estimate, projection, image);
  }
  parts.draw_halo(sample, overlays, projection, painter);
  parts.draw_text(overlays, painter);
  return image;
}

}  // namespace ironbird::simulator
