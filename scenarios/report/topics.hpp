#pragma once

namespace ironbird::scenarios {

// Topics of a flight that more than one figure shows.

inline constexpr const char* kEstimateTopic = "/autopilot/estimate";
inline constexpr const char* kTrajectoryTopic = "/autopilot/trajectory";
inline constexpr const char* kSetpointTopic = "/autopilot/setpoint";

}  // namespace ironbird::scenarios
