#pragma once

#include "simulator/render/image.hpp"

namespace ironbird::scenarios {

/// How far two pictures are apart.
struct ImageDistance {
  bool same_size = true;
  double changed = 0.0;
  int greatest = 0;
  double mean = 0.0;
  double likeness = 1.0;

  bool identical() const { return same_size && greatest == 0; }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("same_size", self.same_size, "1", "false: nothing else was compared");
    visit("changed", self.changed, "1", "share of pixels that differ at all", 0.0, 1.0);
    visit("greatest", self.greatest, "1", "greatest difference of a channel, 0..255");
    visit("mean", self.mean, "1", "mean difference of a channel, 0..255");
    visit("likeness", self.likeness, "1",
          "structural similarity of the brightness, mean over windows of 8x8 pixels; 1: the same to the eye",
          -1.0, 1.0);
  }
};

/// Compares pixel by pixel and as the eye does. Structural similarity: Wang, Bovik, Sheikh, Simoncelli
/// (2004), eq. 13, with even windows that overlap by half.
ImageDistance compare(const simulator::Image& a, const simulator::Image& b);

/// The first picture in faint grey, with what differs in red. Both of one size.
simulator::Image difference_picture(const simulator::Image& a, const simulator::Image& b);

}  // namespace ironbird::scenarios
