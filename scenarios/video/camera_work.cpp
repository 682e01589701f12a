#include "scenarios/video/camera_work.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::scenarios {
namespace {

using simulator::Camera;
using simulator::Pose;
using simulator::Vector3;

constexpr double kBehind = 2.7;             // m
constexpr double kAbove = 1.15;             // m
constexpr double kPositionTime = 0.25;      // s, lag of the camera's anchor
constexpr double kDirectionTime = 0.9;      // s, lag of the direction that "behind" means
constexpr double kLowest = 0.35;            // m above the ground
constexpr double kChaseFieldOfView = 0.80;  // rad
constexpr double kTopFieldOfView = 0.70;    // rad
constexpr double kMargin = 4.0;             // m around the points of the top view

Vector3 nose_N(const Pose& pose) {
  const Vector3 x_N = pose.q_NB * Vector3::UnitX();
  const Vector3 level_N(x_N.x(), x_N.y(), 0.0);
  return level_N.norm() > 1e-3 ? Vector3(level_N.normalized()) : Vector3::UnitX();
}

}  // namespace

std::vector<Camera> chase_cameras(const std::vector<Pose>& poses, double period) {
  std::vector<Camera> cameras;
  if (poses.empty()) {
    return cameras;
  }
  const double position_gain = 1.0 - std::exp(-period / kPositionTime);
  const double direction_gain = 1.0 - std::exp(-period / kDirectionTime);
  Vector3 anchor_N = poses.front().p_NB_N;
  Vector3 ahead_N = nose_N(poses.front());
  for (const Pose& pose : poses) {
    anchor_N += position_gain * (pose.p_NB_N - anchor_N);
    const Vector3 mixed_N = ahead_N + direction_gain * (nose_N(pose) - ahead_N);
    // A nose that turned right round leaves no direction between; keep the old one until it has moved on.
    ahead_N = mixed_N.norm() > 1e-3 ? Vector3(mixed_N.normalized()) : ahead_N;
    Camera camera;
    camera.p_N = anchor_N - kBehind * ahead_N - kAbove * Vector3::UnitZ();
    camera.p_N.z() = std::min(camera.p_N.z(), -kLowest);
    camera.target_N = 0.5 * (anchor_N + pose.p_NB_N) + 0.25 * ahead_N;
    camera.field_of_view = kChaseFieldOfView;
    cameras.push_back(camera);
  }
  return cameras;
}

Camera top_camera(const std::vector<Vector3>& points_N, double aspect) {
  Vector3 low_N = points_N.empty() ? Vector3::Zero() : points_N.front();
  Vector3 high_N = low_N;
  for (const Vector3& point_N : points_N) {
    low_N = low_N.cwiseMin(point_N);
    high_N = high_N.cwiseMax(point_N);
  }
  const double north = 0.5 * (high_N.x() - low_N.x()) + kMargin;
  const double east = 0.5 * (high_N.y() - low_N.y()) + kMargin;
  const double above = std::max(north, east / aspect) / std::tan(0.5 * kTopFieldOfView);
  Camera camera;
  camera.target_N = Vector3(0.5 * (low_N.x() + high_N.x()), 0.5 * (low_N.y() + high_N.y()), 0.0);
  camera.p_N = camera.target_N + Vector3(0.0, 0.0, low_N.z() - above);
  camera.field_of_view = kTopFieldOfView;
  return camera;
}

}  // namespace ironbird::scenarios
