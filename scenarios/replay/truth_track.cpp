#include "scenarios/replay/truth_track.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>

#include "scenarios/bench/run_time.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Quaternion;
using autopilot::Vector3;
using hil_bridge::Time;

constexpr Time kLongestTruthGap = std::chrono::seconds(1);
constexpr std::ptrdiff_t kLeastNeighbours = 5;

using Position = std::vector<RecordedPosition>::const_iterator;

/// The derivative at `centre` of the cubic that fits best.
Vector3 slope(Position begin, Position end, Time centre, double half_width) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
  for (Position at = begin; at != end; ++at) {
    const double u = to_seconds(at->stamp - centre) / half_width;
    const Eigen::Vector4d powers(1.0, u, u * u, u * u * u);
    normal += powers * powers.transpose();
    right += powers * at->p_NB_N.transpose();
  }
  const Eigen::Matrix<double, 4, 3> cubic = normal.ldlt().solve(right);
  return cubic.row(1).transpose() / half_width;
}

/// The samples before and after a time, and how far it is from the first to the second.
template <class Sample>
struct Between {
  const Sample& before;
  const Sample& after;
  double share;
};

template <class Sample>
std::optional<Between<Sample>> around(const std::vector<Sample>& samples, Time when) {
  const auto after = std::lower_bound(samples.begin(), samples.end(), when,
                                      [](const Sample& sample, Time time) { return sample.stamp < time; });
  if (after == samples.end()) return std::nullopt;
  if (after->stamp == when) return Between<Sample>{*after, *after, 0.0};
  if (after == samples.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const Time gap = after->stamp - before->stamp;
  if (gap > kLongestTruthGap) return std::nullopt;
  return Between<Sample>{*before, *after, to_seconds(when - before->stamp) / to_seconds(gap)};
}

}  // namespace

void add_slopes(std::vector<RecordedPosition>& positions, double over) {
  const Time half = from_seconds(0.5 * over);
  // Stamps are written with few digits.
  const Time slack = std::chrono::milliseconds(1);
  const auto earlier = [](const RecordedPosition& position, Time time) { return position.stamp < time; };
  std::vector<std::pair<bool, Vector3>> slopes;
  for (const RecordedPosition& position : positions) {
    const Time from = position.stamp - half;
    const Time to = position.stamp + half;
    const Position begin = std::lower_bound(positions.cbegin(), positions.cend(), from - slack, earlier);
    const Position end = std::lower_bound(positions.cbegin(), positions.cend(), to + slack, earlier);
    const bool reaches = positions.front().stamp <= from + slack && positions.back().stamp >= to - slack;
    const bool known = reaches && end - begin >= kLeastNeighbours;
    slopes.emplace_back(known,
                        known ? slope(begin, end, position.stamp, to_seconds(half)) : Vector3::Zero().eval());
  }
  for (std::size_t k = 0; k < positions.size(); ++k) {
    positions[k].velocity_known = slopes[k].first;
    positions[k].v_NB_N = slopes[k].second;
  }
}

std::size_t move_to_body(RecordedEstimate& truth, const Vector3& p_BA_B) {
  const TruthTrack track(truth);
  std::vector<RecordedPosition> moved;
  for (RecordedPosition position : truth.positions) {
    const auto q_NB = track.attitude(position.stamp);
    if (!q_NB) continue;
    position.p_NB_N -= *q_NB * p_BA_B;
    moved.push_back(position);
  }
  const std::size_t taken_out = truth.positions.size() - moved.size();
  truth.positions = std::move(moved);
  return taken_out;
}

std::optional<Vector3> TruthTrack::position(Time when) const {
  const auto found = around(truth_.positions, when);
  if (!found) return std::nullopt;
  const auto& [before, after, share] = *found;
  return before.p_NB_N + share * (after.p_NB_N - before.p_NB_N);
}

std::optional<Vector3> TruthTrack::velocity(Time when) const {
  const auto found = around(truth_.positions, when);
  if (!found || !found->before.velocity_known || !found->after.velocity_known) return std::nullopt;
  const auto& [before, after, share] = *found;
  return before.v_NB_N + share * (after.v_NB_N - before.v_NB_N);
}

std::optional<Quaternion> TruthTrack::attitude(Time when) const {
  const auto found = around(truth_.attitudes, when);
  if (!found) return std::nullopt;
  return found->before.q_NB.slerp(found->share, found->after.q_NB);
}

}  // namespace ironbird::scenarios
