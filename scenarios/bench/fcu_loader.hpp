#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "hil_bridge/virtual_fcu/firmware_host.hpp"

namespace ironbird::scenarios {

/// Takes `[fcu.parameters] NAME = value` out of `root` and into `config`, each value checked against type,
/// unit and bounds of the firmware's parameter of that name. The firmware's own default is always allowed.
/// What is wrong is added to `findings`, one line each.
void take_fcu_parameters(toml::table& root, hil_bridge::VirtualFcuConfig& config,
                         std::vector<std::string>& findings);

}  // namespace ironbird::scenarios
