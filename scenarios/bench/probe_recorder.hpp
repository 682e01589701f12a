#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "autopilot/module/module.hpp"
#include "scenarios/record/recorder.hpp"

namespace ironbird::scenarios {

/// Records what the modules of the autopilot show of themselves: topic `/autopilot/SLOT/KIND/probe`, one
/// number per field.
///
/// A kind that begins to fly later gets its topic then; the topic of one that was replaced gets no more
/// messages.
class ProbeRecorder {
 public:
  using Time = std::chrono::nanoseconds;

  /// @param period  least time between two messages of a topic
  ProbeRecorder(Recorder& recorder, Time period) : recorder_(recorder), period_(period) {}

  /// From now on shows `module`, which flies in `slot`, instead of the one that flew there before. It
  /// outlives its time there.
  void watch(const std::string& slot, const std::string& kind, const autopilot::Module& module);

  /// To be called before the recorder looks.
  void observe(Time now);

 private:
  struct Probe {
    std::string slot;
    std::string topic;
    const autopilot::Module* module;
    std::vector<double> values;
  };

  Recorder& recorder_;
  Time period_;
  Time next_{0};
  std::deque<Probe> probes_;
};

}  // namespace ironbird::scenarios
