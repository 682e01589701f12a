#pragma once

namespace ironbird::scenarios {

// Topics of a log that more than one room writes or shows.

inline constexpr const char* kTruthTopic = "/truth/state";
inline constexpr const char* kSensorsTopic = "/autopilot/sensors";
inline constexpr const char* kCommandTopic = "/autopilot/command";
inline constexpr const char* kFlightTopic = "/autopilot/flight";
inline constexpr const char* kEstimateTopic = "/autopilot/estimate";
inline constexpr const char* kRouteTopic = "/autopilot/route";
inline constexpr const char* kTrajectoryTopic = "/autopilot/trajectory";
inline constexpr const char* kSetpointTopic = "/autopilot/setpoint";
inline constexpr const char* kStatusTopic = "/fcu/status";
inline constexpr const char* kOutputTopic = "/fcu/output_raw";
inline constexpr const char* kUnitAttitudeTopic = "/fcu/attitude";
inline constexpr const char* kBatteryTopic = "/fcu/battery";
inline constexpr const char* kRcTopic = "/fcu/rc";
inline constexpr const char* kEventTopic = "/bench/event";
inline constexpr const char* kRecordedAttitudeTopic = "/recorded/attitude";
inline constexpr const char* kRecordedPositionTopic = "/recorded/position";
inline constexpr const char* kRecordedFixTopic = "/recorded/fix";
inline constexpr const char* kRecordedPhaseTopic = "/recorded/phase";
inline constexpr const char* kRecordedOriginTopic = "/recorded/origin";
inline constexpr const char* kDifferenceTopic = "/compared/difference";

}  // namespace ironbird::scenarios
