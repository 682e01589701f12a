#include "scenarios/video/film_shots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "scenarios/config/user_error.hpp"
#include "scenarios/video/camera_work.hpp"

namespace ironbird::scenarios {
namespace {

using simulator::Camera;
using simulator::Pose;
using simulator::Vector3;

constexpr double kLongest =
    86400.0;  // s, as long as a run may last; all pictures of a film are planned in memory

const Camera& fixed(const std::string& name, const FilmOptions& options) {
  for (const NamedCamera& camera : options.cameras) {
    if (camera.name == name) {
      return camera.camera;
    }
  }
  throw std::invalid_argument("film: there is no camera named '" + name + "'");
}

// One stamp of centuries makes pictures without end.
void refuse_length(const std::string& of, double begin, double end, const FilmOptions& options) {
  if (std::min(options.end, end) - std::max(options.begin, begin) <= kLongest) return;
  std::array<char, 160> span{};
  std::snprintf(span.data(), span.size(), " lasts from %.1f s to %.1f s", begin, end);
  throw UserError("film: " + of + span.data() + ", a film at most " +
                  std::to_string(static_cast<int>(kLongest)) +
                  " s: cut the log, or take out the time stamp that is wrong");
}

}  // namespace

std::vector<double> frame_times(const std::string& of, double begin, double end, const FilmOptions& options) {
  refuse_length(of, begin, end, options);
  const double first = std::max(options.begin, begin);
  const double last = std::min(options.end, end);
  const auto count =
      static_cast<std::size_t>(std::max(1.0, std::floor((last - first) * options.frame_rate + 1.5)));
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) {
    times[i] = first + static_cast<double>(i) / options.frame_rate;
  }
  return times;
}

void aim_cameras(FilmScript& script, const FilmOptions& options) {
  std::vector<Pose> poses;
  std::vector<Vector3> everything_N = script.planned_path_N;
  for (const FilmFrame& frame : script.frames) {
    poses.push_back(frame.truth.pose);
    everything_N.push_back(frame.truth.pose.p_NB_N);
  }
  const std::vector<Camera> chase = chase_cameras(poses, 1.0 / options.frame_rate);
  const Camera top = top_camera(everything_N, static_cast<double>(options.width) / options.height);
  std::size_t cut = 0;
  std::string name = "chase";
  for (std::size_t i = 0; i < script.frames.size(); ++i) {
    for (; cut < options.cuts.size() && options.cuts[cut].at <= script.frames[i].time; ++cut) {
      name = options.cuts[cut].camera;
    }
    script.frames[i].camera = name == "chase" ? chase[i] : name == "top" ? top : fixed(name, options);
  }
}

}  // namespace ironbird::scenarios
