#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace ironbird::scenarios {

/// "Comes within `band` of the target in `time`, and stays there until the window closes."
struct SettlesConfig {
  std::string band;
  std::string time;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("band", self.band, "", "greatest distance from the target, a quantity in the signal's unit");
    visit("time", self.time, "", "time to get there after the window opens, a quantity in s");
  }
};

/// "Is within `tolerance` of the target at some time, at the latest `by`."
struct ReachesConfig {
  std::string tolerance;
  std::string by;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("tolerance", self.tolerance, "",
          "distance that counts as reached, a quantity in the signal's unit");
    visit("by", self.by, "",
          "time of the run by which it must be reached, a quantity in s; empty: until the end");
  }
};

/// "Lies between `low` and `high`."
struct BandConfig {
  std::string low;
  std::string high;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("low", self.low, "", "a quantity in the signal's unit");
    visit("high", self.high, "", "a quantity in the signal's unit");
  }
};

/// One requirement as it stands in a scenario file. Exactly one kind of assertion is given; what it is about
/// is `signal`, or the difference of the two signals in `error`, or, for the kinds that say so, something
/// else.
///
/// A quantity is a text with a unit (`"25 deg"`), or with a number in the unit of what is judged (`"1.5"`). A
/// vector is judged by its norm, or by its distance from `to_point`. A moment is a time (`"10 s"`), an event
/// (`"offboard"`) or a time after an event (`"gnss_dropout + 5 s"`); of several events of the same name the
/// first one counts.
struct CheckConfig {
  std::string name;
  std::string signal;
  std::vector<std::string> error;
  std::string after;
  std::string until;
  std::string to;
  std::optional<Eigen::Vector3d> to_point;
  std::string tolerated_for;

  std::optional<std::string> rms_below;
  std::optional<std::string> stays_below;
  std::optional<std::string> stays_above;
  std::optional<BandConfig> stays_within;
  std::optional<std::string> final_below;
  std::optional<SettlesConfig> settles;
  std::optional<std::string> overshoot_below;
  std::optional<std::string> stays_within_tube;
  std::optional<ReachesConfig> reaches;
  std::optional<std::vector<std::string>> order_of_events;
  std::optional<std::vector<std::string>> none_of_events;
  std::optional<std::string> happens;
  std::optional<std::string> never_happens;
  std::optional<std::string> metric_below;
  std::optional<std::string> metric_above;
  std::string metric;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "what is required, as the verdict prints it");
    visit("signal", self.signal, "", "path of the signal judged");
    visit("error", self.error, "", "paths of two signals: their difference is judged, angles the short way");
    visit("after", self.after, "", "moment from which on it is judged; empty: the start");
    visit("until", self.until, "", "moment up to which it is judged; empty: the end");
    visit("to", self.to, "", "target of settles, reaches and overshoot_below, a quantity; empty: 0");
    visit("to_point", self.to_point, "SI", "target of settles and reaches for a vector");
    visit("tolerated_for", self.tolerated_for, "",
          "stays_…: a violation counts only when it lasts longer than this, a quantity in s");
    visit("rms_below", self.rms_below, "", "root mean square is below this");
    visit("stays_below", self.stays_below, "", "every value is below this");
    visit("stays_above", self.stays_above, "", "every value is above this");
    visit("stays_within", self.stays_within, "", "every value lies in this band");
    visit("final_below", self.final_below, "", "the last magnitude is below this");
    visit("settles", self.settles, "", "comes into a band around the target and stays");
    visit("overshoot_below", self.overshoot_below, "", "passes the target by less than this");
    visit("stays_within_tube", self.stays_within_tube, "",
          "a position is never farther than this from the polyline of the waypoints");
    visit("reaches", self.reaches, "", "comes close to the target once");
    visit("order_of_events", self.order_of_events, "", "these events happen in this order");
    visit("none_of_events", self.none_of_events, "", "events, none of which may happen, in the window");
    visit("happens", self.happens, "", "a condition holds at some time: `path == value`, also != < <= > >=");
    visit("never_happens", self.never_happens, "", "a condition holds at no time");
    visit("metric", self.metric, "", "name of the metric that metric_below and metric_above judge");
    visit("metric_below", self.metric_below, "", "the metric is below this");
    visit("metric_above", self.metric_above, "", "the metric is above this");
  }
};

}  // namespace ironbird::scenarios
