#include "scenarios/video/film.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "scenarios/config/user_error.hpp"
#include "scenarios/config/write_file.hpp"
#include "scenarios/video/frame_workers.hpp"

namespace ironbird::scenarios {
namespace {

constexpr std::size_t kTrailStride = 3;  // frames between two corners of the trail

void check(const FilmScript& script) {
  const VideoFormat format = script.format();
  if (format.width % 2 != 0 || format.height % 2 != 0) {
    throw std::invalid_argument("film of " + std::to_string(format.width) + "x" +
                                std::to_string(format.height) + " px: both sides must be even");
  }
  if (script.frame_rate < 1 || script.frame_rate > 120) {
    throw std::invalid_argument("frame_rate = " + std::to_string(script.frame_rate) + " 1/s, must be 1..120");
  }
  if (script.frames.empty()) {
    throw std::invalid_argument("film without frames");
  }
}

int worker_count(int wanted, std::size_t frames) {
  const int processors = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  const int count = wanted > 0 ? wanted : std::clamp(processors, 1, 4);
  return std::min(count, static_cast<int>(std::min<std::size_t>(frames, 64)));
}

// Corners at the same frames as the vehicle's own trail.
void add_ghost_trail(const FilmScript& script, std::size_t first, std::size_t index,
                     simulator::Overlays& overlays) {
  for (std::size_t i = first; i < index; i += kTrailStride) {
    if (script.frames[i].estimate) overlays.ghost_trail_N.push_back(script.frames[i].estimate->p_NB_N);
  }
  if (script.frames[index].estimate) overlays.ghost_trail_N.push_back(script.frames[index].estimate->p_NB_N);
}

const char* preset(simulator::Quality quality) {
  return quality == simulator::Quality::kPreview ? "ultrafast" : "veryfast";
}

}  // namespace

simulator::Overlays overlays_at(const FilmScript& script, std::size_t index) {
  const FilmFrame& frame = script.frames[index];
  simulator::Overlays overlays;
  overlays.title = script.title;
  overlays.captions = frame.captions;
  overlays.estimate = frame.estimate;
  overlays.planned_path_N = script.planned_path_N;
  overlays.waypoints = script.waypoints;
  for (std::size_t i = 0; i < overlays.waypoints.size(); ++i) {
    overlays.waypoints[i].reached = static_cast<int>(i) < frame.waypoints_reached;
  }
  const auto length = static_cast<std::size_t>(script.trail_seconds * script.frame_rate);
  // Corners stay where they are from frame to frame, or the trail would crawl.
  const std::size_t first = (index > length ? index - length : 0) / kTrailStride * kTrailStride;
  for (std::size_t i = first; i < index; i += kTrailStride) {
    overlays.trail_N.push_back(script.frames[i].truth.pose.p_NB_N);
  }
  overlays.trail_N.push_back(frame.truth.pose.p_NB_N);
  if (script.ghost_trail) add_ghost_trail(script, first, index, overlays);
  for (const FixMark& fix : script.fixes) {
    if (fix.time <= frame.time && fix.time > frame.time - script.trail_seconds)
      overlays.marks_N.push_back(fix.p_N);
  }
  return overlays;
}

void prepare_renderer_environment() {
  ::setenv("LP_NATIVE_VECTOR_WIDTH", "256", 1);
  ::setenv("LP_NUM_THREADS", "0", 0);
}

bool film(const FilmScript& script, VideoSink& sink, int workers, const FilmProgress& progress) {
  check(script);
  FrameWorkers crew(script, worker_count(workers, script.frames.size()));
  for (std::size_t i = 0; i < script.frames.size(); ++i) {
    sink.write(crew.wait_for(i));
    crew.release(i);
    if (progress && !progress(i + 1, script.frames.size())) {
      return false;
    }
  }
  sink.finish();
  return true;
}

bool film_to_file(const FilmScript& script, const std::filesystem::path& file, int workers,
                  const FilmProgress& progress) {
  check(script);
  check_writable(file);
  std::unique_ptr<VideoSink> sink;
  if (file.extension() == ".mp4") {
    sink = make_mp4_sink(file, script.format(), preset(script.renderer.quality));
  } else if (file.extension() == ".y4m") {
    sink = make_y4m_sink(file, script.format());
  } else {
    throw std::invalid_argument(file.string() + ": a film is .mp4 or .y4m");
  }
  return film(script, *sink, workers, progress);
}

std::vector<simulator::Image> stills(const FilmScript& script, const std::vector<std::size_t>& indices) try {
  prepare_renderer_environment();
  simulator::SceneRenderer renderer(script.renderer);
  std::vector<simulator::Image> images;
  for (const std::size_t index : indices) {
    const FilmFrame& frame = script.frames.at(index);
    images.push_back(renderer.render(frame.truth, frame.camera, overlays_at(script, index)));
  }
  return images;
} catch (const std::runtime_error& error) {
  throw UserError(error.what());  // the machine cannot draw: the text names what it lacks
}

}  // namespace ironbird::scenarios
