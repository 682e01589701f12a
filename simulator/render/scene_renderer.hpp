#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "simulator/render/camera.hpp"
#include "simulator/render/image.hpp"
#include "simulator/render/render_sample.hpp"

namespace ironbird::simulator {

/// How much work goes into a picture.
enum class Quality : std::uint8_t {
  kPreview,  ///< no antialiasing of solid things, small shadows, coarse marks on the ground
  kFilm,     ///< four samples per pixel
  kStill     ///< nine samples per pixel, fine shadows
};

constexpr std::array<std::pair<Quality, std::string_view>, 3> enumerators(Quality) {
  return {{{Quality::kPreview, "preview"}, {Quality::kFilm, "film"}, {Quality::kStill, "still"}}};
}

/// What to draw and how large.
struct RendererParams {
  std::string vehicle_scene;
  std::string field_scene;
  int width = 1280;
  int height = 720;
  Quality quality = Quality::kFilm;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("vehicle_scene", self.vehicle_scene, "", "absolute path of the vehicle's MJCF");
    visit("field_scene", self.field_scene, "", "absolute path of the field's MJCF");
    visit("width", self.width, "px", "of the picture", 16, 3840);
    visit("height", self.height, "px", "of the picture", 16, 2160);
    visit("quality", self.quality, "1", "preview, film or still");
  }
};

/// Turns a sample of the truth into a picture. Knows nothing of engines that integrate and never changes a
/// flight. The same arguments give the same bytes, whatever was drawn before and however many threads the
/// OpenGL library uses.
///
/// The OpenGL library reads LP_NATIVE_VECTOR_WIDTH and LP_NUM_THREADS when the first renderer of a process is
/// made; the caller sets them (256 bits: wider vectors crash some versions of it). One renderer per thread at
/// a time.
class SceneRenderer {
 public:
  /// @throws std::invalid_argument when a scene cannot be read or a size is out of bounds
  explicit SceneRenderer(const RendererParams& params);
  ~SceneRenderer();

  /// The picture, opaque. Rotors turning faster than 40 rad/s are drawn as discs.
  Image render(const RenderSample& sample, const Camera& camera, const Overlays& overlays);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ironbird::simulator
