#pragma once

#include <optional>
#include <string>

#include "scenarios/requirements/timeline.hpp"

namespace ironbird::scenarios {

/// A time of the run, or a time after an event.
struct Moment {
  double offset = 0.0;
  std::string event;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("offset", self.offset, "s", "after the event");
    visit("event", self.event, "", "empty: the start of the run");
  }

  /// Reads `10 s`, `offboard` or `gnss_dropout + 5 s`. @throws std::invalid_argument naming `what`
  static Moment read(const std::string& text, const std::string& what);

  /// When that is, s; nothing while the event has not happened.
  std::optional<double> when(const Timeline& timeline) const;
};

/// The part of a run in which a check looks. Both ends belong to it.
class Window {
 public:
  Window() = default;
  /// @param after, until  as in a scenario file; empty: the start, the end
  Window(const std::string& after, const std::string& until);

  bool contains(double time, const Timeline& timeline);

  /// Why no moment of a run that ended at `end`, s, lay in it.
  std::string why_empty(double end) const;

  /// Why it was still open when the run ended at `end`, s, although it has an end; empty when it was not.
  std::string why_open(double end) const;

 private:
  Moment after_;
  std::optional<Moment> until_;
  std::optional<double> from_;
  std::optional<double> to_;
  std::size_t events_seen_ = 0;
  bool resolved_once_ = false;
};

}  // namespace ironbird::scenarios
