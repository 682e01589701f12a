#pragma once

#include <string>
#include <vector>

#include "autopilot/modules.hpp"
#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/transport/awake_cores.hpp"
#include "scenarios/fcu/unit_line.hpp"

namespace ironbird::scenarios {

/// Many times of the same thing.
struct Spread {
  std::vector<hil_bridge::Time> times;  ///< rising

  explicit Spread(std::vector<hil_bridge::Time> unordered = {});
  /// The time that this share of all does not exceed; zero when there are none. @param share  0..1
  hil_bridge::Time quantile(double share) const;
};

/// What was measured, and beside it how late this machine wakes a sleeper in the same minute.
struct LatencyReport {
  std::string where;
  std::string round_trip_meaning;
  Spread round_trip;
  std::string turn_around_meaning;
  Spread turn_around;
  Spread jitter;                     ///< overshoot of clock_nanosleep, 1 ms at a time
  std::vector<std::string> missing;  ///< of what a run in real time asks of this machine, a line each
};

/// Takes the rights of a run in real time for this thread; processes that measure beside it are begun before.
/// @return what this machine did not grant, a line each
std::vector<std::string> take_rights_of_a_run(const hil_bridge::transport::AwakeCores& awake);

std::string latency_text(const LatencyReport& report);
std::string latency_json(const LatencyReport& report);

/// Asks a unit for its clock after every fourth IMU frame. @throws as UnitOnLine, and transport::LinkError
/// when nothing is answered
LatencyReport latency_of_line(const UnitAddress& address, double seconds);

/// Makes a pseudo-terminal with the scenario's virtual unit at one end, in a process of its own, and serial
/// port, autopilot and gate at the other. The unit, which stays disarmed, measures: from the IMU frame's
/// leaving to the command's arrival. @throws ConfigError, transport::LinkError
LatencyReport latency_of_self(const std::string& scenario, double seconds, const autopilot::Modules& modules);

}  // namespace ironbird::scenarios
