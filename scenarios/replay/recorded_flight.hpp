#pragma once

#include <optional>
#include <string>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/state_estimate.hpp"
#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::scenarios {

/// An attitude that was recorded beside the sensors.
struct RecordedAttitude {
  hil_bridge::Time stamp{};
  autopilot::Quaternion q_NB = autopilot::Quaternion::Identity();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when it was valid");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
  }
};

/// A position and velocity that were recorded beside the sensors.
struct RecordedPosition {
  hil_bridge::Time stamp{};
  autopilot::Vector3 p_NB_N = autopilot::Vector3::Zero();
  autopilot::Vector3 v_NB_N = autopilot::Vector3::Zero();
  bool position_known = true;
  bool height_known = true;
  bool velocity_known = true;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when they were valid");
    visit("p_NB_N", self.p_NB_N, "m",
          "position; in a log from the origin of the estimate that was made anew, since that is known");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity over ground");
    visit("position_known", self.position_known, "1", "whoever estimated it believed north and east");
    visit("height_known", self.height_known, "1", "and down");
    visit("velocity_known", self.velocity_known, "1", "and the velocity");
  }
};

/// A fix as the receiver told it, in the frame of an estimate.
struct RecordedFix {
  hil_bridge::Time stamp{};
  autopilot::Vector3 p_N = autopilot::Vector3::Zero();
  autopilot::Vector3 v_N = autopilot::Vector3::Zero();
  double horizontal_accuracy = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when it was measured");
    visit("p_N", self.p_N, "m", "position from the estimate's origin");
    visit("v_N", self.v_N, "m/s", "velocity over ground");
    visit("horizontal_accuracy", self.horizontal_accuracy, "m", "the receiver's own estimate, 1 sigma");
  }
};

/// An estimate that was recorded beside the sensors, or truth.
struct RecordedEstimate {
  std::string name;  ///< whose it is: "PX4", "RTK"
  std::vector<RecordedAttitude> attitudes;
  std::vector<RecordedPosition> positions;
  autopilot::LocalOrigin origin;  ///< of the positions; not known: wherever the flight began
};

/// What the recorder's own autopilot was doing, from one time on.
struct RecordedPhase {
  hil_bridge::Time stamp{};
  bool armed = false;
  bool airborne = false;
  std::string mode;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "since when");
    visit("armed", self.armed, "1", "its motors may turn");
    visit("airborne", self.airborne, "1", "its land detector says so");
    visit("mode", self.mode, "", "what it was told to do, in its own word: mission; empty: not told");
  }
};

/// Where the recorded estimate counts its positions from.
struct RecordedOrigin {
  autopilot::Vector3 p_N = autopilot::Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "seen from the origin of the estimate that was made anew");
  }
};

/// From when to when.
struct Interval {
  hil_bridge::Time begin{};
  hil_bridge::Time end{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("begin", self.begin, "ns", "from when");
    visit("end", self.end, "ns", "until when, included");
  }
};

/// A flight that somebody else's autopilot or recorder logged: its sensors as a flight-control unit would
/// have sent them, and what was estimated at the time. Times are since the first sample of the IMU.
struct RecordedFlight {
  std::string what;                           ///< "PX4 1.14.0 on PX4_FMU_V6C"
  std::vector<hil_bridge::Arrival> messages;  ///< by time; of those at one time the IMU's is the last
  std::vector<RecordedEstimate> estimates;    ///< the first is compared with
  std::vector<Interval> airborne;             ///< as the recorder's own land detector told
  std::vector<RecordedPhase> phases;          ///< by time; empty: nobody told of them
  hil_bridge::Time end{};                     ///< of the last sample of the IMU
  std::vector<std::string> remarks;           ///< what is missing or odd, a line each
};

}  // namespace ironbird::scenarios
