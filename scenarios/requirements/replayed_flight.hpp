#pragma once

#include <optional>
#include <string>

namespace ironbird::scenarios {

/// A recorded flight that an estimator was fed with, and how: what a reader of the figures has to know.
struct ReplayedFlight {
  std::string file;
  std::string recorder;
  std::string compared_with;
  bool simulated = false;
  std::optional<int> magnetometer = {};
  std::string magnetometer_source;
  double declination = 0.0;
  std::string declination_source;
  double gnss_delay = 0.0;
  std::string gnss_delay_source;
  double window_begin = 0.0;
  double window_end = 0.0;
  std::string window_source;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("file", self.file, "", "name of the log");
    visit("recorder", self.recorder, "", "what recorded it: system, version, board");
    visit("compared_with", self.compared_with, "", "whose estimate; empty: there is none");
    visit("simulated", self.simulated, "1", "no vehicle flew: the sensors are a model's");
    visit("magnetometer", self.magnetometer, "1", "instance that was taken; none: there is none");
    visit("magnetometer_source", self.magnetometer_source, "", "why that one");
    visit("declination", self.declination, "rad", "from true to magnetic north, east positive");
    visit("declination_source", self.declination_source, "", "named, or which model of the field");
    visit("gnss_delay", self.gnss_delay, "s", "age of a fix on arrival");
    visit("gnss_delay_source", self.gnss_delay_source, "", "who says so");
    visit("window_begin", self.window_begin, "s", "from when on the estimates are compared");
    visit("window_end", self.window_end, "s", "until when");
    visit("window_source", self.window_source, "", "named, or how it was found");
  }
};

}  // namespace ironbird::scenarios
