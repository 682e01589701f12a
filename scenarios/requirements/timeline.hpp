#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "autopilot/signals.hpp"

namespace ironbird::scenarios {

/// Events about the estimated position whose text is a distance: they are found by their kind.
inline constexpr std::array<std::string_view, 3> kPositionEvents{"fixes_disagree", "position_reset",
                                                                 "origin_moved"};

/// Whether the position is in doubt.
inline constexpr std::array<std::string_view, 2> kDoubtEvents{"doubtful", "sure"};

/// What the pilot sees of the ground: the vehicle leaves it, comes down on it well, or otherwise.
inline constexpr std::string_view kLiftedOff = "lifted_off";
inline constexpr std::string_view kCrashed = "crashed";
inline constexpr std::array<std::string_view, 3> kGroundEvents{kLiftedOff, "landed", kCrashed};

/// Kind of the event that a request was not accepted. Its text is that of the request, ": " and the reason.
inline constexpr std::string_view kRefusedEvent = "refused";

/// Something that happened in a run.
struct RunEvent {
  double time = 0.0;
  std::string kind;
  std::string text;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("time", self.time, "s", "since the start of the run");
    visit("kind", self.kind, "", "class of event: phase, arming, waypoint, health, fault, …");
    visit("text", self.text, "", "what happened");
  }
};

/// True when a check that says `name` means this event.
bool is_called(const RunEvent& event, std::string_view name);

/// The events of a run in order of time. An event is called by its text (`offboard`), by its kind (`fault`),
/// or, where the text is not enough, by both (`fault_end:gnss_dropout`). The names of the flight's own
/// events, `take_off` or `landing`, mean just these: that somebody asked for a take-off is
/// `request:take_off`. A request that was refused is found by its kind, `refused`, and by `refused:take_off`.
class Timeline {
 public:
  void add(double time, std::string kind, std::string text) {
    events_.push_back({time, std::move(kind), std::move(text)});
  }

  const std::vector<RunEvent>& events() const { return events_; }

  /// Number of the first event of this name not before `from`, s, that is not one of `but_not`; nothing when
  /// there is none.
  std::optional<std::size_t> find(std::string_view name, double from,
                                  const std::vector<std::size_t>& but_not = {}) const;

  /// Time of the first event of this name not before `from`, s; nothing when there is none.
  std::optional<double> first(std::string_view name,
                              double from = -std::numeric_limits<double>::infinity()) const;

 private:
  std::vector<RunEvent> events_;
};

/// Turns changes of the autopilot's signals into events: phases of flight (`offboard`), arming (`armed`,
/// `unarmed`), waypoints (`waypoint_1` for the first one reached, and on from there through every route and
/// flight of the run, `route_finished`, once for each route as it stands), health of the estimate
/// (`degraded`), doubt about the position
/// (`doubtful`, `sure`; by how much fixes and dead reckoning differ is `fixes_disagree`), a position that
/// jumps
/// (`position_reset`), an origin that moves (`origin_moved`), and why the phase changed when nobody asked for
/// it (`cause:position_unknown`).
///
/// A trajectory point that is not valid tells nothing of the route.
///
/// A health that worsens is an event at once; one that betters, when it has lasted half a second: a sensor
/// that fails now and then makes one event, not hundreds.
class EventDetector {
 public:
  /// @param signals  must outlive the detector
  explicit EventDetector(const autopilot::Signals& signals) : signals_(signals) {}

  /// Adds what has changed since the previous call. To be called after every tick.
  void observe(double time, Timeline& timeline) {
    Seen fresh = now();
    if (fresh.health != seen_.health || betters_) fresh.health = settled(fresh.health, time);
    if (!(fresh == seen_)) report(fresh, time, timeline);
    look_at_route(time, timeline);
    look_at_places(time, timeline);
  }

 private:
  struct Seen {
    autopilot::FlightPhase phase = autopilot::FlightPhase::kDisarmed;
    autopilot::PhaseCause cause = autopilot::PhaseCause::kPlanned;
    bool armed = false;
    autopilot::Health health = autopilot::Health::kUninitialised;
    bool doubtful = false;
    autopilot::Vector3 position_reset_sum_N = autopilot::Vector3::Zero();
    bool operator==(const Seen&) const = default;
  };

  /// The end of a route, which may be come to again after an override.
  struct Finish {
    std::uint32_t reached = 0;
    std::uint32_t revision = 0;
    bool operator==(const Finish&) const = default;
  };

  Seen now() const {
    return {signals_.flight.phase,
            signals_.flight.cause,
            signals_.flight.fcu.armed,
            signals_.estimate.health,
            signals_.estimate.position_doubtful,
            signals_.estimate.position_reset_sum_N};
  }
  autopilot::Health settled(autopilot::Health health, double time);
  void report(const Seen& fresh, double time, Timeline& timeline);
  void look_at_route(double time, Timeline& timeline);
  void look_at_places(double time, Timeline& timeline);

  const autopilot::Signals& signals_;
  Seen seen_;
  autopilot::Vector3 offset_N_ = autopilot::Vector3::Zero();
  autopilot::LocalOrigin origin_;
  std::uint32_t reached_ = 0;           // of this route
  std::uint32_t of_routes_before_ = 0;  // waypoints reached
  std::optional<Finish> finish_;
  bool betters_ = false;
  double better_since_ = 0.0;  // s
};

}  // namespace ironbird::scenarios
