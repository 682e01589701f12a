#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/types/linear_algebra.hpp"
#include "simulator/types/rotor_commands.hpp"

namespace ironbird::simulator {

/// Position and attitude of the vehicle.
struct Pose {
  Vector3 p_NB_N = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_NB_N", self.p_NB_N, "m", "position from the local origin");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
  }
};

/// What the picture shows of the vehicle at one instant.
struct RenderSample {
  Pose pose;
  std::array<double, kMaxRotors> rotor_angle{};
  std::array<double, kMaxRotors> rotor_speed{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pose", self.pose, "", "where the vehicle is");
    visit("rotor_angle", self.rotor_angle, "rad", "turn of each rotor, seen from above, counter-clockwise");
    visit("rotor_speed", self.rotor_speed, "rad/s", "speed of each rotor; a fast one is drawn as a disc");
  }
};

/// A mark in the air with a short text.
struct WaypointMark {
  Vector3 p_N = Vector3::Zero();
  std::string label;
  bool reached = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position from the local origin");
    visit("label", self.label, "", "text in the mark, at best one or two letters");
    visit("reached", self.reached, "1", "drawn faded");
  }
};

/// What is drawn over the scene. All in N.
struct Overlays {
  std::vector<Vector3> planned_path_N;
  std::vector<Vector3> trail_N;
  std::vector<Vector3> ghost_trail_N;
  std::vector<Vector3> marks_N;
  std::vector<WaypointMark> waypoints;
  std::optional<Pose> estimate;
  std::string title;
  std::vector<std::string> captions;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("planned_path_N", self.planned_path_N, "m", "corners of the path to fly");
    visit("trail_N", self.trail_N, "m", "where the vehicle has been, oldest first");
    visit("ghost_trail_N", self.ghost_trail_N, "m", "where the ghost has been, oldest first");
    visit("marks_N", self.marks_N, "m", "single points, small");
    visit("waypoints", self.waypoints, "", "numbered marks");
    visit("estimate", self.estimate, "", "where the autopilot believes to be; drawn as a ghost");
    visit("title", self.title, "", "first line of text");
    visit("captions", self.captions, "", "further lines of text");
  }
};

}  // namespace ironbird::simulator
