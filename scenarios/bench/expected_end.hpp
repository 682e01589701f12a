#pragma once

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// When a run is likely to end, s: for whoever waits, and for nothing else.
///
/// What `end_after` names is followed back to its cause: the events that it waits for, the legs of the route
/// at the path manager's limits, take-off and descent at the controller's speeds. What nobody can know, such
/// as a failsafe that lands, and what events do to the route under way, is not thought of.
/// @return at most `duration`, which it is when the end cannot be told
double expected_end(const LoadedScenario& loaded);

/// The end to show `now` seconds into the run: a run that takes longer than expected is nearly over until it
/// is. All in s.
double shown_end(double expected, double now, double duration);

}  // namespace ironbird::scenarios
