#pragma once

#include <vector>

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// A box that stands in the way.
struct BoxObstacle {
  Vector3 position = Vector3::Zero();
  Vector3 half_size = {0.5, 0.5, 0.5};
  double heading = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("position", self.position, "m", "centre, in N");
    visit("half_size", self.half_size, "m", "half its edges: forward, right, down before it is turned");
    visit("heading", self.heading, "rad", "turned about Nz");
  }
};

/// What the vehicle can touch.
struct FieldParams {
  bool ground = true;
  std::vector<BoxObstacle> boxes;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("ground", self.ground, "1", "there is a plane at height zero");
    visit("boxes", self.boxes, "", "boxes that do not move");
  }
};

}  // namespace ironbird::simulator
