#pragma once

#include <string>
#include <vector>

#include "scenarios/requirements/metrics.hpp"

namespace ironbird::scenarios {

/// The figures of an estimate that was made anew beside a recorded one: names, units, meanings; no values.
/// @param whose  the recorded estimate is: "PX4"
std::vector<Metric> difference_metrics(const std::string& whose);

}  // namespace ironbird::scenarios
