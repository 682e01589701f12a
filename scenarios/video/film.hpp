#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/video/video_sink.hpp"
#include "simulator/render/camera.hpp"
#include "simulator/render/image.hpp"
#include "simulator/render/render_sample.hpp"
#include "simulator/render/scene_renderer.hpp"

namespace ironbird::scenarios {

/// One picture of a film.
struct FilmFrame {
  double time = 0.0;
  simulator::RenderSample truth;
  std::optional<simulator::Pose> estimate;
  simulator::Camera camera;
  int waypoints_reached = 0;
  std::vector<std::string> captions;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("time", self.time, "s", "since the start of the run");
    visit("truth", self.truth, "", "what the picture shows");
    visit("estimate", self.estimate, "", "where the autopilot believes to be");
    visit("camera", self.camera, "", "from where");
    visit("waypoints_reached", self.waypoints_reached, "1", "so many are drawn faded");
    visit("captions", self.captions, "", "lines of text");
  }
};

/// A fix of a receiver: where it said that the vehicle was.
struct FixMark {
  double time = 0.0;
  simulator::Vector3 p_N = simulator::Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("time", self.time, "s", "from when on it is shown, as long as the trail");
    visit("p_N", self.p_N, "m", "position");
  }
};

/// Everything a film needs, and nothing else: any frame can be drawn alone, in any order, by any process.
struct FilmScript {
  simulator::RendererParams renderer;
  int frame_rate = 30;
  double trail_seconds = 12.0;
  std::string title;
  std::vector<simulator::Vector3> planned_path_N;
  std::vector<simulator::WaypointMark> waypoints;
  bool ghost_trail = false;
  std::vector<FixMark> fixes;
  std::vector<FilmFrame> frames;

  VideoFormat format() const { return {renderer.width, renderer.height, frame_rate}; }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("renderer", self.renderer, "", "scene and size");
    visit("frame_rate", self.frame_rate, "1/s", "pictures per second", 1, 120);
    visit("trail_seconds", self.trail_seconds, "s", "length of the trail", 0.0, 600.0);
    visit("title", self.title, "", "first line of text");
    visit("planned_path_N", self.planned_path_N, "m", "corners of the path");
    visit("waypoints", self.waypoints, "", "marks");
    visit("ghost_trail", self.ghost_trail, "1", "the ghost has a trail of its own");
    visit("fixes", self.fixes, "", "of a receiver, in order of time");
    visit("frames", self.frames, "", "one per picture");
  }
};

/// What is drawn over frame `index`: a pure function of the script.
simulator::Overlays overlays_at(const FilmScript& script, std::size_t index);

/// Called in the calling process after every picture, with the pictures done and all. Returns false to stop.
using FilmProgress = std::function<bool(std::size_t done, std::size_t all)>;

/// Draws the script and writes it to the sink, in order. The pictures are drawn by `workers` processes of
/// their own (0: one per processor, four at most), so a crash of the OpenGL library cannot take the caller
/// down.
/// @return false when `progress` asked to stop; the sink is then not finished
/// @throws std::runtime_error when a worker or the sink fails
bool film(const FilmScript& script, VideoSink& sink, int workers = 0, const FilmProgress& progress = {});

/// Draws a film into `file`, whose extension .mp4 or .y4m says how. Errors as film().
bool film_to_file(const FilmScript& script, const std::filesystem::path& file, int workers = 0,
                  const FilmProgress& progress = {});

/// Draws single frames in this process. @return one picture per index
/// @throws std::invalid_argument when a scene cannot be read
std::vector<simulator::Image> stills(const FilmScript& script, const std::vector<std::size_t>& indices);

}  // namespace ironbird::scenarios
