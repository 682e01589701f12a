#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "hil_bridge/interlock/command_check.hpp"
#include "hil_bridge/interlock/gate.hpp"
#include "hil_bridge/interlock/interlock_state.hpp"

namespace ironbird::hil_bridge {

/// What a kill sends.
enum class InterlockProfile : std::uint8_t {
  kBench,   ///< zero thrust, repeated: the vehicle is tied down
  kFlight,  ///< nothing: silence hands over to the pilot's radio, while zeros in the air are a crash
};

constexpr std::array<std::pair<InterlockProfile, std::string_view>, 2> enumerators(InterlockProfile) {
  return {{{InterlockProfile::kBench, "bench"}, {InterlockProfile::kFlight, "flight"}}};
}

struct InterlockConfig {
  InterlockProfile profile = InterlockProfile::kBench;
  CommandLimits limits;
  Time unit_timeout = std::chrono::milliseconds(100);

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("profile", self.profile, "1", "what a kill sends");
    visit("limits", self.limits, "", "what a motor command may be");
    visit("unit_timeout", self.unit_timeout, "ns", "OFFBOARD_TIMEOUT of the unit");
  }
};

/// What the interlock has done so far.
struct InterlockStatus {
  InterlockState state = InterlockState::kCold;
  std::string_view why = "nothing has been heard yet";
  Time since{};
  std::array<std::uint64_t, 6> refused{};
  std::uint64_t passed = 0;
};

/// The one gate through which motor commands leave the bench. docs/safety.md says what it is for; the state
/// machine is in interlock_state.hpp.
///
/// Housekeeping passes always; what could turn a motor passes above zero in `Live` only; what changes the
/// unit (parameters, calibrations) passes only while it reports disarmed and nothing is released.
class Interlock final : public Gate {
 public:
  explicit Interlock(const InterlockConfig& config);

  /// Looks at everything, once in every control period, before commands are sent.
  const InterlockStatus& step(InterlockInputs in, Time now);

  /// One motor command. @return what leaves, or none
  std::optional<rosflight::OffboardControl> command(const StampedCommand& wanted, Time now);

  /// The autopilot commanded what cannot even be written down.
  void refuse(CommandFault fault, Time now);

  /// Everything else. A motor command that comes this way is refused: it has no stamp.
  std::optional<rosflight::Message> pass(const rosflight::Message& message, Time now) override;

  const InterlockStatus& status() const { return status_; }

 private:
  bool refused_too_long() const;
  std::optional<rosflight::OffboardControl> idle() const;

  InterlockConfig config_;
  CommandCheck check_;
  InterlockStatus status_;
  bool unit_disarmed_ = false;
  std::optional<Time> refused_since_;  // the first refusal that no passed command followed
  Time refused_last_{};
};

}  // namespace ironbird::hil_bridge
