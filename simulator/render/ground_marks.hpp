#pragma once

#include <Eigen/Core>
#include <cstddef>
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

  /// Red, green, blue (0..255 each) and opacity (0..1), premultiplied.
  using Paint = Eigen::Array4f;

  /// One of the copies, ready to be looked up again and again.
  class Sampler {
   public:
    /// The paint at a point, bilinear; nothing outside.
    Paint operator()(float north, float east) const {
      const float x = east * scale_ + east_offset_;
      const float y = north_offset_ - north * scale_;
      const auto last = static_cast<float>(size_ - 1);
      if (!(x >= 0.0F && y >= 0.0F && x < last && y < last)) {
        return Paint::Zero();
      }
      const int i = static_cast<int>(x);
      const int j = static_cast<int>(y);
      const float fx = x - static_cast<float>(i);
      const float fy = y - static_cast<float>(j);
      const Paint* at = texels_ + static_cast<std::ptrdiff_t>(j) * size_ + i;
      const Paint upper = at[0] + fx * (at[1] - at[0]);
      const Paint lower = at[size_] + fx * (at[size_ + 1] - at[size_]);
      return upper + fy * (lower - upper);
    }

   private:
    friend class GroundMarks;
    const Paint* texels_ = nullptr;
    int size_ = 0;
    float scale_ = 1.0F;
    float east_offset_ = 0.0F;
    float north_offset_ = 0.0F;
  };

  /// The copy whose texels are about `footprint`, m, wide.
  Sampler sampler(float footprint) const;

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
