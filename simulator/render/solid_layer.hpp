#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulator/render/camera.hpp"
#include "simulator/render/render_sample.hpp"

namespace ironbird::simulator {

/// A rectangle of pixels: left and upper edge included, right and lower edge not.
struct PixelRect {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;

  int width() const { return right - left; }
  int height() const { return bottom - top; }
  bool empty() const { return right <= left || bottom <= top; }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("left", self.left, "px", "first column");
    visit("top", self.top, "px", "first row");
    visit("right", self.right, "px", "column after the last");
    visit("bottom", self.bottom, "px", "row after the last");
  }
};

/// One rotor of the drawn vehicle.
struct RotorGeometry {
  Vector3 p_B = Vector3::Zero();
  double radius = 0.0;
  int joint_address = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_B", self.p_B, "m", "centre of the rotor's disc, its axis along Bz");
    visit("radius", self.radius, "m", "of the blade tips");
    visit("joint_address", self.joint_address, "1", "place of its angle among the engine's coordinates");
  }
};

/// A place painted on the ground.
struct GroundMark {
  Vector3 p_N = Vector3::Zero();
  double radius = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "its middle");
    visit("radius", self.radius, "m", "of its outer edge, 0: absent");
  }
};

/// Which solid things to draw.
enum class SolidPart : std::uint8_t {
  kVehicle = 1,
  kField = 2,
  kEverything = 3,
};

/// Solid things drawn into a part of a picture. Rows from the top of `rect`. No `describe`: a picture is not
/// logged as numbers.
struct SolidPicture {
  PixelRect rect;
  int samples = 1;                  ///< per pixel and axis
  std::vector<std::uint8_t> rgba;   ///< of every sample, rect.width() * samples per row, rows from the BOTTOM
  std::vector<float> window_depth;  ///< the same for 0..1 depth; 1 where there is nothing
  double near = 0.0;                ///< m
  double far = 0.0;                 ///< m

  /// Distance along the optical axis for a value of window_depth, m.
  float depth(float window) const {
    return static_cast<float>(near * far / (far - static_cast<double>(window) * (far - near)));
  }
};

/// Reads the scene and throws it away: whether it, and every mesh and texture that it names, is there, and
/// whether it is a vehicle's. Files that vehicle or field name are relative to the vehicle's folder.
/// @param vehicle  absolute path without symbolic links, like `field`
/// @throws std::invalid_argument in one line, which begins with the path of the wrong file
void check_scene(const std::string& vehicle, const std::string& field);

/// Draws the solid things of a scene, vehicle and obstacles but not the ground, with MuJoCo's renderer into
/// an offscreen buffer of its own OpenGL context. The only file of this room that knows MuJoCo or its frame.
class SolidLayer {
 public:
  /// @param vehicle  scene.xml of the vehicle
  /// @param field    scene of the field
  /// @param max_width, max_height  greatest size of a picture in samples, px
  /// @throws std::invalid_argument when a scene cannot be read or lacks a body that the vehicle must have
  SolidLayer(const std::string& vehicle, const std::string& field, int max_width, int max_height);
  ~SolidLayer();
  SolidLayer(const SolidLayer&) = delete;
  SolidLayer& operator=(const SolidLayer&) = delete;

  /// Poses the vehicle. Rotors above `blur_speed`, rad/s, lose their blades: the caller draws a disc.
  void pose(const RenderSample& sample, double blur_speed);

  /// The part of a picture that the posed solids can touch.
  PixelRect bounds(const Projection& projection, SolidPart part) const;

  /// Draws what `bounds` covers. The returned picture is valid until the next call.
  /// @param samples  per pixel and axis, 1..4
  const SolidPicture& draw(const Projection& projection, PixelRect rect, int samples, SolidPart part);

  /// Empty space around a raw glyph, px.
  static constexpr int kGlyphMargin = 4;

  /// Opacity of a character of the built-in typeface, see GlyphAtlas.
  struct RawGlyph {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> coverage;  ///< rows from the top
  };
  RawGlyph glyph(char character);

  const std::vector<RotorGeometry>& rotors() const { return rotors_; }
  const Vector3& sun_N() const { return sun_N_; }                ///< unit vector towards the sun
  const Vector3& ground_color() const { return ground_color_; }  ///< red, green, blue, 0..1
  const GroundMark& helipad() const { return helipad_; }
  const GroundMark& compass_rose() const { return compass_rose_; }
  double vehicle_radius() const { return vehicle_radius_; }  ///< m, of a sphere about B that contains it
  /// A sphere about all obstacles; radius 0 when there are none.
  const GroundMark& obstacles() const { return obstacles_; }

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
  std::vector<RotorGeometry> rotors_;
  Vector3 sun_N_;
  Vector3 ground_color_ = Vector3(0.36, 0.47, 0.26);
  GroundMark helipad_;
  GroundMark compass_rose_;
  GroundMark obstacles_;
  double vehicle_radius_ = 0.0;
  SolidPicture picture_;
};

}  // namespace ironbird::simulator
