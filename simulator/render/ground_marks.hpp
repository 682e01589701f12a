#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "simulator/render/glyph_atlas.hpp"
#include "simulator/render/image.hpp"
#include "simulator/render/solid_layer.hpp"

namespace ironbird::simulator {

/// What is painted on the ground around the origin: the landing pad and the compass rose with its letters. A
/// picture seen from above, north up, with smaller copies for the distance.
class GroundMarks {
 public:
  /// @param helipad, compass_rose  radius 0: absent
  GroundMarks(const GroundMark& helipad, const GroundMark& compass_rose, const GlyphAtlas& letters);

  bool empty() const { return levels_.empty(); }
  const Vector3& center_N() const { return center_N_; }
  double half_size() const { return half_size_; }  ///< m, from the middle to an edge

  /// Colour (0..255 each) and opacity (0..1), premultiplied.
  struct Paint {
    float r = 0.0F;
    float g = 0.0F;
    float b = 0.0F;
    float opacity = 0.0F;
  };

  /// The paint at a point, averaged over about `footprint`, m.
  Paint sample(float north, float east, float footprint) const;

 private:
  struct Level {
    int size = 0;
    std::vector<Paint> paint;
  };

  Vector3 center_N_ = Vector3::Zero();
  double half_size_ = 0.0;
  std::vector<Level> levels_;
};

}  // namespace ironbird::simulator
