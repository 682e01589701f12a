#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenarios/record/log.hpp"
#include "simulator/render/render_sample.hpp"

namespace ironbird::scenarios {

/// Poses of a log between their samples: positions linearly, attitudes along the shortest turn.
class PoseTrack {
 public:
  /// @throws std::out_of_range when the topic has no p_NB_N and q_NB
  explicit PoseTrack(const LogTopic& topic);
  bool empty() const { return time_->empty(); }
  double begin() const { return time_->front(); }
  double end() const { return time_->back(); }
  /// The pose at a time; the first or last one outside the log.
  simulator::Pose at(double time) const;

 private:
  simulator::Pose sample(std::size_t index) const;

  const std::vector<double>* time_;
  std::array<const std::vector<double>*, 7> columns_;
};

}  // namespace ironbird::scenarios
