#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/hil_fcu/stand_motors.hpp"
#include "simulator/types/rotor_commands.hpp"

namespace ironbird::hil_bridge {

/// A unit whose outputs turn real motors on a stand, too: what OUTPUT_RAW tells is what they are to do. The
/// gate of the bus decides whether they do it; who keeps the gate steps them, after it has looked at
/// everything.
class StandUnit final : public Fcu {
 public:
  /// @param unit    as it is reached; outlives this
  /// @param params  of the bench as the one who commands; its motors are the first outputs of the unit
  /// @param bus     outlives this
  StandUnit(Fcu& unit, const can::EscControllerParams& params, transport::FrameBus& bus)
      : unit_(unit), params_(params), bus_(bus) {}

  /// Before this nothing happens on the bus. @param gate  outlives this
  void open(const InterlockStatus& gate) { motors_.emplace(params_, bus_, gate, now_); }
  /// Null: not open yet.
  StandMotors* motors() { return motors_ ? &*motors_ : nullptr; }

  void advance(Time now) override;
  void receive(std::vector<Arrival>& out) override;
  void send(const rosflight::Message& message) override { unit_.send(message); }

 private:
  void take(const rosflight::RosflightOutputRaw& told);

  Fcu& unit_;
  can::EscControllerParams params_;
  transport::FrameBus& bus_;
  std::optional<StandMotors> motors_;
  std::array<double, simulator::kMaxRotors> wanted_{};
  Time now_{};
};

}  // namespace ironbird::hil_bridge
