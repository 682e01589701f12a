#pragma once

#include <string>
#include <vector>

#include "hil_bridge/serial_fcu/parameter_set.hpp"
#include "scenarios/fcu/unit_line.hpp"

namespace ironbird::scenarios {

/// How a push of parameters to a unit ended.
struct PushResult {
  std::vector<hil_bridge::ParameterDifference> left;  ///< what was wanted and is not so, or not known to be
  std::string broken_off;                             ///< why it was not brought to an end, or empty
};

/// Sets everything, sees what that changed besides, sets again, and reads all back. Says on standard error
/// what is being waited for, and breaks off when the unit falls silent or is armed.
/// @throws transport::LinkError when the unit does not report at the start that it is disarmed; nothing was
/// set
PushResult push_parameters(const std::vector<hil_bridge::ParameterRecord>& wanted, UnitOnLine& unit);

}  // namespace ironbird::scenarios
