#pragma once

#include <string>

#include "hil_bridge/serial_fcu/parameter_set.hpp"

namespace ironbird::scenarios {

/// What this parameter's value must be, "must be between 0 and 1", when it is not; empty when it is. By the
/// firmware's table, as for scenarios; the firmware itself takes anything. The firmware's own default is
/// always right: some lie outside, and block arming until somebody has chosen. A name that the table does not
/// know, or has with another type, is not judged here.
std::string complaint_about_value(const hil_bridge::ParameterRecord& record);

}  // namespace ironbird::scenarios
