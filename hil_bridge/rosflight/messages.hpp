#pragma once

#include <variant>

#include "hil_bridge/rosflight/command_messages.hpp"
#include "hil_bridge/rosflight/parameter_messages.hpp"
#include "hil_bridge/rosflight/sensor_messages.hpp"
#include "hil_bridge/rosflight/state_messages.hpp"
#include "hil_bridge/rosflight/vocabulary.hpp"

// The vocabulary of the ROSflight 2.0 link: its 25 messages as plain structs. `kId` and `kName` are those of
// the dialect, and so are the names, types and order of what `describe` visits: dialect.hpp computes lengths
// and check bytes from them.

namespace ironbird::hil_bridge::rosflight {

using Message =
    std::variant<Heartbeat, ParamRequestRead, ParamRequestList, ParamValue, ParamSet, AttitudeQuaternion,
                 RcChannels, Timesync, OffboardControl, SmallImu, SmallMag, SmallBaro, DiffPressure,
                 SmallRange, RosflightCmd, RosflightCmdAck, RosflightOutputRaw, RosflightStatus,
                 RosflightVersion, RosflightAuxCmd, ExternalAttitude, RosflightHardError, RosflightGnss,
                 RosflightBatteryStatus, Statustext>;

}  // namespace ironbird::hil_bridge::rosflight
