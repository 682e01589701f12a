#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/record/log.hpp"
#include "scenarios/video/film.hpp"

namespace ironbird::scenarios {

/// A camera with a name.
struct NamedCamera {
  std::string name;
  simulator::Camera camera;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "that cuts and snapshots use");
    visit("camera", self.camera, "", "where it stands");
  }
};

/// From when on the film looks through which camera.
struct FilmCut {
  double at = 0.0;
  std::string camera = "chase";

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("at", self.at, "s", "since the start of the run", 0.0, 86400.0);
    visit("camera", self.camera, "", "chase, top, or the name of a fixed camera");
  }
};

/// How to make a film of a log.
struct FilmOptions {
  std::filesystem::path vehicle_scene;
  std::filesystem::path field;
  int width = 1280;
  int height = 720;
  int frame_rate = 30;
  simulator::Quality quality = simulator::Quality::kFilm;
  double begin = 0.0;
  double end = 1e9;
  bool from_estimate = false;
  std::vector<NamedCamera> cameras;
  std::vector<FilmCut> cuts;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("vehicle_scene", self.vehicle_scene, "", "how the vehicle looks");
    visit("field", self.field, "", "how the place looks");
    visit("width", self.width, "px", "even", 16, 3840);
    visit("height", self.height, "px", "even", 16, 2160);
    visit("frame_rate", self.frame_rate, "1/s", "pictures per second of flight", 1, 120);
    visit("quality", self.quality, "1", "preview, film or still");
    visit("begin", self.begin, "s", "first picture", 0.0, 1e9);
    visit("end", self.end, "s", "last picture at the latest", 0.0, 1e9);
    visit("from_estimate", self.from_estimate, "1",
          "show the estimate: for a flight whose truth nobody knows");
    visit("cameras", self.cameras, "", "fixed cameras");
    visit("cuts", self.cuts, "", "in order of time; before the first: chase");
  }
};

/// The film of a log. @throws UserError when the log lacks the poses or they last longer than a day,
/// std::invalid_argument when a cut names a camera that is not there. Of a replayed flight:
/// replay_film_script()
FilmScript film_script(const Log& log, const FilmOptions& options);

/// The frame of the script at a time, or the nearest. @param time  s since the start of the run
std::size_t frame_at(const FilmScript& script, double time);

}  // namespace ironbird::scenarios
