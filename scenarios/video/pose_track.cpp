#include "scenarios/video/pose_track.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::scenarios {

PoseTrack::PoseTrack(const LogTopic& topic)
    : time_(&topic.time()), columns_{&topic.column("p_NB_N.x"), &topic.column("p_NB_N.y"),
                                     &topic.column("p_NB_N.z"), &topic.column("q_NB.w"),
                                     &topic.column("q_NB.x"),   &topic.column("q_NB.y"),
                                     &topic.column("q_NB.z")} {}

simulator::Pose PoseTrack::sample(std::size_t index) const {
  const auto value = [&](std::size_t column) { return (*columns_[column])[index]; };
  const simulator::Quaternion q_NB(value(3), value(4), value(5), value(6));
  return {simulator::Vector3(value(0), value(1), value(2)), q_NB.normalized()};
}

simulator::Pose PoseTrack::at(double time) const {
  const auto after = std::upper_bound(time_->begin(), time_->end(), time);
  if (after == time_->begin()) {
    return sample(0);
  }
  const auto index = static_cast<std::size_t>(after - time_->begin());
  if (index == time_->size()) {
    return sample(index - 1);
  }
  const simulator::Pose a = sample(index - 1);
  const simulator::Pose b = sample(index);
  const double share = (time - (*time_)[index - 1]) / ((*time_)[index] - (*time_)[index - 1]);
  return {a.p_NB_N + share * (b.p_NB_N - a.p_NB_N), a.q_NB.slerp(share, b.q_NB)};
}

}  // namespace ironbird::scenarios
