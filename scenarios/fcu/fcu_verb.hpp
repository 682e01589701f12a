#pragma once

#include <functional>

#include "autopilot/modules.hpp"

namespace ironbird::scenarios {

class VerbOptions;

/// What one of the sub-verbs does, once its options are read. @return the exit code
using FcuWork = std::function<int(const autopilot::Modules&)>;

FcuWork declare_fcu_calibrate(VerbOptions& options);
FcuWork declare_fcu_info(VerbOptions& options);
FcuWork declare_fcu_monitor(VerbOptions& options);
FcuWork declare_fcu_params(VerbOptions& options);
FcuWork declare_fcu_preflight(VerbOptions& options);
FcuWork declare_fcu_serve(VerbOptions& options);

}  // namespace ironbird::scenarios
