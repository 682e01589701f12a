#include "scenarios/video/film_script.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>

#include "autopilot/types/flight_status.hpp"
#include "autopilot/types/state_estimate.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/held_column.hpp"
#include "scenarios/record/logged_route.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/video/film_shots.hpp"
#include "scenarios/video/pose_track.hpp"

namespace ironbird::scenarios {
namespace {

using simulator::kMaxRotors;
using simulator::Vector3;

constexpr double kEventShown = 3.0;                // s that an event's text stays in the picture
constexpr double kBladeSpeed = 40.0;               // rad/s, up to here blades turn as they do
constexpr std::array<double, 2> kTurn{1.0, -1.0};  // rotors turn left and right alternately

const LogTopic& need(const Log& log, const char* name) {
  const LogTopic* topic = log.topic(name);
  if (topic == nullptr || topic->time().empty()) {
    throw UserError(std::string("film: the log has no ") + name);
  }
  return *topic;
}

std::string metadata(const Log& log, const char* key, const char* otherwise) {
  const auto run = log.metadata().find("run");
  if (run == log.metadata().end()) {
    return otherwise;
  }
  const auto value = run->second.find(key);
  return value == run->second.end() || value->second.empty() ? otherwise : value->second;
}

std::string formatted(const char* format, double a, double b) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

std::string phase_name(double phase) {
  for (const auto& [value, name] : enumerators(autopilot::FlightPhase{})) {
    if (static_cast<int>(value) == static_cast<int>(phase)) {
      std::string text(name);
      std::replace(text.begin(), text.end(), '_', ' ');
      return text;
    }
  }
  return "";
}

// From when to when waypoints that are reached are those of the route that is drawn, s.
struct RouteSpan {
  double begin = 0.0;
  double end = std::numeric_limits<double>::infinity();
};

// Draws the route of the run, and tells when it and its like were in force.
RouteSpan read_route(const Log& log, FilmScript& script) {
  const std::vector<LoggedRoute> routes = logged_routes(log);
  const std::optional<std::size_t> main = main_route(routes);
  if (!main) {
    return {};
  }
  const LoggedRoute& route = routes[*main];
  for (std::size_t i = 0; i < route.waypoints_N.size(); ++i) {
    script.waypoints.push_back({route.waypoints_N[i], std::to_string(i + 1), false});
  }
  script.planned_path_N = route.waypoints_N;
  if (route.cyclic && route.waypoints_N.size() > 2) {
    script.planned_path_N.push_back(route.waypoints_N.front());
  }
  std::size_t first = *main, last = *main;
  while (first > 0 && routes[first - 1].begins_like(route)) --first;
  while (last + 1 < routes.size() && routes[last + 1].begins_like(route)) ++last;
  RouteSpan span{routes[first].since};
  if (last + 1 < routes.size()) span.end = routes[last].until;
  return span;
}

// The last event of the flight that is still fresh, or an empty text. What the FCU says about itself and
// pictures taken are none.
std::string event_at(const LogTopic* events, double time) {
  if (events == nullptr) {
    return "";
  }
  const std::vector<double>& times = events->time();
  const std::vector<std::string>& kinds = events->texts("kind");
  auto i = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  while (i > 0 && (kinds[i - 1] == "fcu" || kinds[i - 1] == "snapshot")) {
    --i;
  }
  if (i == 0 || time - times[i - 1] > kEventShown) return "";
  const std::string& text = events->texts("text")[i - 1];
  // A number says nothing without what it is of.
  const bool is_number = !text.empty() && text[0] >= '0' && text[0] <= '9';
  return is_number ? kinds[i - 1] + " " + text : text;
}

class Director {
 public:
  /// @param route  when the route that is drawn was in force: waypoints reached at other times are not its
  /// own
  Director(const Log& log, const FilmOptions& options, RouteSpan route)
      : options_(options),
        route_(route),
        shown_topic_(need(log, options.from_estimate ? kEstimateTopic : kTruthTopic)),
        shown_(shown_topic_),
        estimate_topic_(log.topic(kEstimateTopic)),
        health_(estimate_topic_, "health", 1.0),
        events_(log.topic(kEventTopic)),
        phase_(log.topic(kFlightTopic), "phase", -1.0),
        operator_setpoint_(log.topic(kFlightTopic), "operator_setpoint", 0.0),
        reached_(log.topic(kTrajectoryTopic), "reached", 0.0),
        trajectory_(log.topic(kTrajectoryTopic)),
        valid_(trajectory_, "valid", 0.0),
        wanted_{HeldColumn(trajectory_, "p_N.x", 0.0), HeldColumn(trajectory_, "p_N.y", 0.0),
                HeldColumn(trajectory_, "p_N.z", 0.0)} {
    for (int i = 0; i < kMaxRotors; ++i) {
      rotors_.emplace_back(&shown_topic_, "rotor_speed[" + std::to_string(i) + "]", 0.0);
    }
  }

  void shoot(FilmScript& script) {
    for (const double time : frame_times(shown_topic_.name(), shown_.begin(), shown_.end(), options_)) {
      script.frames.push_back(frame(time));
    }
    aim_cameras(script, options_);
  }

 private:
  FilmFrame frame(double time) {
    FilmFrame frame;
    frame.time = time;
    frame.truth.pose = shown_.at(time);
    turn_rotors(frame.truth, time);
    const bool is_in_force = time >= route_.begin && time < route_.end;
    if (is_in_force) most_reached_ = static_cast<int>(reached_.at(time));
    frame.waypoints_reached = most_reached_;
    const double speed =
        (shown_.at(time).p_NB_N - shown_.at(time - kSpeedWindow).p_NB_N).norm() / kSpeedWindow;
    std::string first = formatted("%.1f s", time, 0.0);
    const std::string phase = phase_name(phase_.at(time));
    frame.captions.push_back(phase.empty() ? first : first + "   " + phase);
    frame.captions.push_back(
        formatted("height %.1f m   speed %.1f m/s", -frame.truth.pose.p_NB_N.z(), speed));
    add_errors(frame, time);
    if (const std::string event = event_at(events_, time); !event.empty()) {
      frame.captions.push_back("> " + event);
    }
    return frame;
  }

  void add_errors(FilmFrame& frame, double time) {
    const Vector3 wanted_N(wanted_[0].at(time), wanted_[1].at(time), wanted_[2].at(time));
    const double off = (wanted_N - frame.truth.pose.p_NB_N).norm();
    const bool flying = valid_.at(time) > 0.5 && operator_setpoint_.at(time) < 0.5 &&
                        phase_.at(time) == static_cast<double>(autopilot::FlightPhase::kOffboard);
    std::string line;
    const bool has_estimate = estimate_topic_ != nullptr && !estimate_topic_->time().empty() &&
                              health_.at(time) != static_cast<double>(autopilot::Health::kUninitialised);
    if (!options_.from_estimate && has_estimate) {
      frame.estimate = PoseTrack(*estimate_topic_).at(time);
      line = formatted("estimate (ghost) off %.2f m",
                       (frame.estimate->p_NB_N - frame.truth.pose.p_NB_N).norm(), 0.0);
    }
    if (flying) {
      line += formatted(line.empty() ? "tracking off %.2f m" : "   tracking off %.2f m", off, 0.0);
    }
    if (!line.empty()) {
      frame.captions.push_back(line);
    }
  }

  void turn_rotors(simulator::RenderSample& sample, double time) {
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      const double speed = rotors_[i].at(time);
      // At thirty pictures a second true angles of a fast rotor would look like noise.
      const double apparent = std::abs(speed) <= kBladeSpeed ? speed : kApparentSpeed;
      angle_[i] += kTurn[i % 2] * apparent / options_.frame_rate;
      sample.rotor_speed[i] = speed;
      sample.rotor_angle[i] = std::remainder(angle_[i], 2.0 * std::numbers::pi);
    }
  }

  const FilmOptions& options_;
  RouteSpan route_;
  int most_reached_ = 0;
  const LogTopic& shown_topic_;
  PoseTrack shown_;
  const LogTopic* estimate_topic_;
  HeldColumn health_;
  const LogTopic* events_;
  HeldColumn phase_;
  HeldColumn operator_setpoint_;
  HeldColumn reached_;
  const LogTopic* trajectory_;
  HeldColumn valid_;
  std::array<HeldColumn, 3> wanted_;
  std::vector<HeldColumn> rotors_;
  std::array<double, kMaxRotors> angle_{};
};

}  // namespace

FilmScript film_script(const Log& log, const FilmOptions& options) {
  FilmScript script;
  script.renderer = {std::filesystem::absolute(options.vehicle_scene).string(),
                     std::filesystem::absolute(options.field).string(), options.width, options.height,
                     options.quality};
  script.frame_rate = options.frame_rate;
  script.title = metadata(log, "title", "");
  const RouteSpan route = read_route(log, script);
  Director(log, options, route).shoot(script);
  return script;
}

std::size_t frame_at(const FilmScript& script, double time) {
  const auto after = std::lower_bound(script.frames.begin(), script.frames.end(), time,
                                      [](const FilmFrame& frame, double t) { return frame.time < t; });
  if (after == script.frames.begin()) {
    return 0;
  }
  const auto index = static_cast<std::size_t>(after - script.frames.begin());
  if (index == script.frames.size()) {
    return index - 1;
  }
  return time - script.frames[index - 1].time < script.frames[index].time - time ? index - 1 : index;
}

}  // namespace ironbird::scenarios
