#pragma once

#include <optional>

#include "scenarios/replay/px4_records.hpp"
#include "scenarios/replay/recorded_flight.hpp"

namespace ironbird::scenarios {

/// PX4's own estimate, seen from the first origin that it had: it may move, and does in flight when the
/// origin is set.
/// @return nothing when there is none
std::optional<RecordedEstimate> read_px4_estimate(Px4Log& log);

}  // namespace ironbird::scenarios
