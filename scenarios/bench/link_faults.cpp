#include "scenarios/bench/link_faults.hpp"

#include "scenarios/bench/run_time.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::transport::DirectionFaults;
using hil_bridge::transport::LinkFaultConfig;

constexpr double kLongestDelay = 10.0;  // s
constexpr double kFastestLine = 1e9;    // byte/s

void apply(LinkFaultKind kind, double magnitude, DirectionFaults& faults) {
  switch (kind) {
    case LinkFaultKind::kDrop:
      faults.drop = magnitude;
      return;
    case LinkFaultKind::kBurstLoss:
      faults.burst_start = magnitude;
      return;
    case LinkFaultKind::kCorrupt:
      faults.corrupt = magnitude;
      return;
    case LinkFaultKind::kInsert:
      faults.insert = magnitude;
      return;
    case LinkFaultKind::kDuplicate:
      faults.duplicate = magnitude;
      return;
    case LinkFaultKind::kReorder:
      faults.reorder = magnitude;
      return;
    case LinkFaultKind::kLatency:
      faults.latency = from_seconds(magnitude);
      return;
    case LinkFaultKind::kJitter:
      faults.jitter = from_seconds(magnitude);
      return;
    case LinkFaultKind::kByteRate:
      faults.byte_rate = magnitude;
      return;
    case LinkFaultKind::kStall:
    case LinkFaultKind::kHangUp:
      return;
  }
}

}  // namespace

LinkFaultConfig RunningLinkFaults::sum() const {
  LinkFaultConfig config = always_;
  for (const auto& [number, fault] : running_) {
    apply(fault.kind, fault.magnitude, config.outgoing);
    apply(fault.kind, fault.magnitude, config.incoming);
  }
  return config;
}

std::string_view complaint_about(LinkFaultKind kind, double magnitude) {
  switch (kind) {
    case LinkFaultKind::kLatency:
    case LinkFaultKind::kJitter:
      return magnitude >= 0.0 && magnitude <= kLongestDelay ? "" : "must be between 0 and 10 s";
    case LinkFaultKind::kByteRate:
      return magnitude > 0.0 && magnitude <= kFastestLine ? "" : "must be above 0 and at most 1e9 byte/s";
    case LinkFaultKind::kStall:
    case LinkFaultKind::kHangUp:
      return "";
    default:
      return magnitude >= 0.0 && magnitude <= 1.0 ? "" : "must be between 0 and 1";
  }
}

}  // namespace ironbird::scenarios
