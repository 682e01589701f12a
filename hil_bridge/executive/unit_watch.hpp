#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "hil_bridge/interlock/interlock_state.hpp"
#include "hil_bridge/serial_fcu/serial_fcu.hpp"

namespace ironbird::hil_bridge {

/// The switches with which the pilot takes attitude and throttle back, by the parameter that has the channel.
inline constexpr std::array<std::string_view, 2> kOverrideSwitches = {"RC_ATT_OVRD_CHN", "RC_THR_OVRD_CHN"};
inline constexpr int kFirstSwitchChannel = 4;  ///< 0 to 3 are the sticks
inline constexpr int kLastSwitchChannel = 23;  ///< of a frame of the radio

/// Has the pilot what it takes to take over? A switch that lies beyond RC_NUM_CHN is one that the firmware
/// does not hear. @param parameter  gives an integer parameter of the unit by its name, -1 when it is not
/// known
template <class Parameter>
bool switches_mapped(Parameter&& parameter) {
  return std::all_of(kOverrideSwitches.begin(), kOverrideSwitches.end(), [&](std::string_view name) {
    const int channel = parameter(name);
    return channel >= kFirstSwitchChannel && channel <= kLastSwitchChannel &&
           channel < parameter("RC_NUM_CHN");
  });
}
/// The same, of a unit that has told its parameters.
bool override_mapped(const ParameterClient& parameters);

/// Finds out, of a unit, what the interlock wants to know of it.
class UnitWatch {
 public:
  virtual ~UnitWatch() = default;

  /// One message that arrived from the unit.
  virtual void take(const Arrival& arrival) = 0;

  /// Fills in what is about the unit: link, identity, arming, faults, parameters, sensors, radio.
  virtual void report(Time now, InterlockInputs& in) = 0;
};

/// Watches a unit that this process made from the scenario: it only listens. Identity and parameters need no
/// asking.
class OwnUnitWatch final : public UnitWatch {
 public:
  /// @param override_mapped  the pilot can take over: both override switches have a channel
  explicit OwnUnitWatch(bool override_mapped)
      : override_mapped_(override_mapped), listener_({.synchronise = false, .download = false}) {}

  void take(const Arrival& arrival) override { listener_.take(arrival.message, arrival.when); }
  void report(Time now, InterlockInputs& in) override;

 private:
  bool override_mapped_;
  Connection listener_;
};

/// Watches a unit at the other end of a line: what it is and which parameters it has is asked and compared.
class LineUnitWatch final : public UnitWatch {
 public:
  /// @param wanted  parameters that the unit must have; others are nobody's business
  /// @param fcu     outlives this
  LineUnitWatch(const SerialFcu& fcu, std::vector<ParameterRecord> wanted)
      : fcu_(fcu), wanted_(std::move(wanted)) {}

  void take(const Arrival& arrival) override;
  void report(Time now, InterlockInputs& in) override;

  /// Where the unit differs from what is wanted, as far as it is known.
  std::vector<ParameterDifference> different() const;

 private:
  void compare();

  const SerialFcu& fcu_;
  std::vector<ParameterRecord> wanted_;
  bool news_ = true;
  bool equal_ = false;
  bool override_mapped_ = false;
};

/// What a connection knows by listening alone.
void report_presence(const Connection& connection, Time now, InterlockInputs& in);

}  // namespace ironbird::hil_bridge
