#include "scenarios/video/replay_film.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "autopilot/types/state_estimate.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/held_column.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/video/film_shots.hpp"
#include "scenarios/video/pose_track.hpp"

namespace ironbird::scenarios {
namespace {

using simulator::Pose;
using simulator::Quaternion;
using simulator::Vector3;

constexpr double kTurning = 400.0;   // rad/s, of rotors of which nothing is known but that they turn
constexpr double kLongestGap = 2.0;  // s without a recorded estimate, after which it has no place

std::string about(const Log& log, const char* key, const char* otherwise) {
  const auto run = log.metadata().find("run");
  if (run == log.metadata().end()) return otherwise;
  const auto value = run->second.find(key);
  return value == run->second.end() || value->second.empty() ? otherwise : value->second;
}

bool has(const Log& log, const char* name) {
  const LogTopic* topic = log.topic(name);
  return topic != nullptr && !topic->time().empty();
}

/// Numbers of a topic between its samples, linear. Times must be asked in order.
class Between {
 public:
  Between(const LogTopic& topic, const std::vector<std::string>& fields) : time_(topic.time()) {
    for (const std::string& field : fields) columns_.push_back(&topic.column(field));
  }
  /// Moves on to `time`. @return false where there are no two samples around it that are near each other
  bool seek(double time) {
    while (next_ < time_.size() && time_[next_] <= time) ++next_;
    if (next_ == 0 || next_ == time_.size()) return false;
    const double gap = time_[next_] - time_[next_ - 1];
    share_ = gap > 0.0 ? (time - time_[next_ - 1]) / gap : 0.0;
    return gap <= kLongestGap;
  }
  double before(std::size_t column) const { return (*columns_[column])[next_ - 1]; }
  double after(std::size_t column) const { return (*columns_[column])[next_]; }
  double linear(std::size_t column) const {
    return before(column) + share_ * (after(column) - before(column));
  }
  double share() const { return share_; }

 private:
  const std::vector<double>& time_;
  std::vector<const std::vector<double>*> columns_;
  std::size_t next_ = 0;
  double share_ = 0.0;
};

/// Where the recorded estimate saw the vehicle.
class RecordedTrack {
 public:
  explicit RecordedTrack(const Log& log) {
    if (!has(log, kRecordedPositionTopic) || !has(log, kRecordedAttitudeTopic)) return;
    position_.emplace(
        *log.topic(kRecordedPositionTopic),
        std::vector<std::string>{"p_NB_N.x", "p_NB_N.y", "p_NB_N.z", "position_known", "height_known"});
    attitude_.emplace(*log.topic(kRecordedAttitudeTopic),
                      std::vector<std::string>{"q_NB.w", "q_NB.x", "q_NB.y", "q_NB.z"});
  }
  /// Nothing where it is not known. Times must be asked in order.
  std::optional<Pose> at(double time) {
    if (!position_ || !position_->seek(time) || !attitude_->seek(time)) return std::nullopt;
    const bool known = position_->before(3) > 0.5 && position_->after(3) > 0.5 &&
                       position_->before(4) > 0.5 && position_->after(4) > 0.5;
    if (!known) return std::nullopt;
    const Between& q = *attitude_;
    const Quaternion before(q.before(0), q.before(1), q.before(2), q.before(3));
    const Quaternion after(q.after(0), q.after(1), q.after(2), q.after(3));
    return Pose{Vector3(position_->linear(0), position_->linear(1), position_->linear(2)),
                before.slerp(q.share(), after)};
  }

 private:
  std::optional<Between> position_;
  std::optional<Between> attitude_;
};

/// When there is an estimate for the first time, s.
double ready_time(const Log& log) {
  if (has(log, kEstimateTopic)) {
    const LogTopic& estimate = *log.topic(kEstimateTopic);
    const std::vector<double>& health = estimate.column("health");
    for (std::size_t i = 0; i < health.size(); ++i) {
      if (health[i] != static_cast<double>(autopilot::Health::kUninitialised)) return estimate.time()[i];
    }
  }
  throw UserError("film: there was no estimate to show");
}

/// By how much ours counts down further than the recorded one, m: the median of the differences.
double down_apart(const Log& log) {
  if (!has(log, kDifferenceTopic)) return 0.0;
  std::vector<double> differences;
  for (const double down : log.topic(kDifferenceTopic)->column("p_N.z")) {
    if (std::isfinite(down)) differences.push_back(down);
  }
  if (differences.empty()) return 0.0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle;
}

class ReplayDirector {
 public:
  ReplayDirector(const Log& log, const FilmOptions& options)
      : log_(log),
        options_(options),
        ours_(*log.topic(kEstimateTopic)),
        recorded_(log),
        armed_(log.topic(kRecordedPhaseTopic), "armed", 1.0),
        health_(log.topic(kEstimateTopic), "health", 1.0),
        whose_(about(log, "recorded", "recorded")),
        down_apart_(down_apart(log)) {}

  void shoot(FilmScript& script, double ready) {
    for (const double time : frame_times(kEstimateTopic, ready, ours_.end(), options_)) {
      script.frames.push_back(frame(time));
    }
    find_ground(script);
    for (FilmFrame& frame : script.frames) stand_on_ground(frame);
    add_fixes(script);
    aim_cameras(script, options_);
  }

 private:
  FilmFrame frame(double time) {
    FilmFrame frame;
    frame.time = time;
    frame.truth.pose = ours_.at(time);
    frame.estimate = recorded_.at(time);
    if (frame.estimate) frame.estimate->p_NB_N.z() += down_apart_;
    const bool turning = armed_.at(time) > 0.5;
    if (turning) angle_ += kApparentSpeed / options_.frame_rate;
    for (std::size_t i = 0; i < frame.truth.rotor_speed.size(); ++i) {
      frame.truth.rotor_speed[i] = turning ? kTurning : 0.0;
      frame.truth.rotor_angle[i] = std::remainder(i % 2 == 0 ? angle_ : -angle_, 2.0 * std::numbers::pi);
    }
    return frame;
  }

  /// The phase at a time, in the recorder's words.
  std::string phase_at(double time) const {
    if (!has(log_, kRecordedPhaseTopic)) return "";
    const LogTopic& phase = *log_.topic(kRecordedPhaseTopic);
    const auto after = std::upper_bound(phase.time().begin(), phase.time().end(), time);
    if (after == phase.time().begin()) return "";
    const auto k = static_cast<std::size_t>(after - phase.time().begin()) - 1;
    if (phase.column("airborne")[k] > 0.5) {
      const std::string& mode = phase.texts("mode")[k];
      return mode.empty() ? "airborne" : mode;
    }
    return phase.column("armed")[k] > 0.5 ? "on the ground" : "disarmed";
  }

  bool is_airborne(double time) const {
    const std::string phase = phase_at(time);
    return !phase.empty() && phase != "on the ground" && phase != "disarmed";
  }

  void find_ground(const FilmScript& script) {
    const auto standing = std::find_if(script.frames.begin(), script.frames.end(),
                                       [this](const FilmFrame& frame) { return !is_airborne(frame.time); });
    if (standing != script.frames.end()) {
      ground_down_ = standing->truth.pose.p_NB_N.z();
    } else if (has(log_, kRecordedOriginTopic)) {
      ground_down_ = log_.topic(kRecordedOriginTopic)->column("p_N.z").front() + down_apart_;
    }
    for (const FilmFrame& frame : script.frames) {
      const double down = frame.truth.pose.p_NB_N.z();
      if (is_airborne(frame.time) && std::isfinite(down)) ground_down_ = std::max(ground_down_, down);
    }
  }

  void stand_on_ground(FilmFrame& frame) {
    Pose& pose = frame.truth.pose;
    pose.p_NB_N.z() -= ground_down_;
    if (frame.estimate) frame.estimate->p_NB_N.z() -= ground_down_;
    const double speed =
        (ours_.at(frame.time).p_NB_N - ours_.at(frame.time - kSpeedWindow).p_NB_N).norm() / kSpeedWindow;
    char text[160];
    std::snprintf(text, sizeof text, "%.1f s", frame.time);
    const std::string phase = phase_at(frame.time);
    const bool lost = health_.at(frame.time) == static_cast<double>(autopilot::Health::kLost);
    frame.captions.push_back(text + (phase.empty() ? "" : "   " + phase) + (lost ? "   ours is lost" : ""));
    std::snprintf(text, sizeof text, "height %.1f m   speed %.1f m/s", -pose.p_NB_N.z(), speed);
    frame.captions.emplace_back(text);
    if (!frame.estimate) {
      frame.captions.emplace_back("orange: ours   yellow: fixes");
      return;
    }
    const Vector3 off_N = pose.p_NB_N - frame.estimate->p_NB_N;
    std::snprintf(text, sizeof text, " (ghost) off %.2f m across, %.2f m down, %.1f deg",
                  off_N.head<2>().norm(), off_N.z(),
                  pose.q_NB.angularDistance(frame.estimate->q_NB) * 180.0 / std::numbers::pi);
    frame.captions.push_back(whose_ + text);
    frame.captions.push_back("orange: ours   blue: " + whose_ + "   yellow: fixes");
  }

  void add_fixes(FilmScript& script) const {
    if (!has(log_, kRecordedFixTopic)) return;
    const LogTopic& fixes = *log_.topic(kRecordedFixTopic);
    for (std::size_t i = 0; i < fixes.time().size(); ++i) {
      script.fixes.push_back(
          {fixes.time()[i],
           {fixes.column("p_N.x")[i], fixes.column("p_N.y")[i], fixes.column("p_N.z")[i] - ground_down_}});
    }
  }

  const Log& log_;
  const FilmOptions& options_;
  PoseTrack ours_;
  RecordedTrack recorded_;
  HeldColumn armed_;
  HeldColumn health_;
  std::string whose_;
  double down_apart_;
  double ground_down_ = 0.0;  // m, in N of our estimate
  double angle_ = 0.0;
};

}  // namespace

bool is_replayed(const Log& log) {
  return has(log, kRecordedPositionTopic) || has(log, kRecordedAttitudeTopic) ||
         has(log, kRecordedFixTopic) || has(log, kRecordedPhaseTopic);
}

FilmScript replay_film_script(const Log& log, const FilmOptions& options) {
  const double ready = ready_time(log);
  FilmScript script;
  script.renderer = {std::filesystem::absolute(options.vehicle_scene).string(),
                     std::filesystem::absolute(options.field).string(), options.width, options.height,
                     options.quality};
  script.frame_rate = options.frame_rate;
  script.title = "Replay: " + about(log, "flight", "a recorded flight");
  script.ghost_trail = true;
  ReplayDirector(log, options).shoot(script, ready);
  return script;
}

}  // namespace ironbird::scenarios
