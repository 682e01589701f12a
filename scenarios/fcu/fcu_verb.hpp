#pragma once

#include <functional>

#include "autopilot/modules.hpp"

namespace CLI {
class App;
}

namespace ironbird::scenarios {

/// What one of the sub-verbs does, once its options are read. @return the exit code
using FcuWork = std::function<int(const autopilot::Modules&)>;

FcuWork declare_fcu_calibrate(CLI::App& app);
FcuWork declare_fcu_info(CLI::App& app);
FcuWork declare_fcu_monitor(CLI::App& app);
FcuWork declare_fcu_params(CLI::App& app);
FcuWork declare_fcu_preflight(CLI::App& app);
FcuWork declare_fcu_serve(CLI::App& app);

}  // namespace ironbird::scenarios
