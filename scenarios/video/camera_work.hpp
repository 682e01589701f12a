#pragma once

#include <vector>

#include "simulator/render/camera.hpp"
#include "simulator/render/render_sample.hpp"

namespace ironbird::scenarios {

/// Cameras that follow the vehicle from behind and above, smoothly. A pure function of the poses.
/// @param poses  one per frame
/// @param period  between frames, s
std::vector<simulator::Camera> chase_cameras(const std::vector<simulator::Pose>& poses, double period);

/// A camera straight above that sees all the points, north up.
simulator::Camera top_camera(const std::vector<simulator::Vector3>& points_N, double aspect);

}  // namespace ironbird::scenarios
