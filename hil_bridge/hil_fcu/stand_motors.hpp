#pragma once

#include <span>
#include <vector>

#include "hil_bridge/can/esc_controller.hpp"
#include "hil_bridge/interlock/interlock.hpp"

namespace ironbird::hil_bridge {

/// Real motors on a stand, on a bus on which the bench is the one who commands them: the gate of the bus,
/// docs/safety.md R11.
///
/// Commands above zero leave only while the interlock is `Live`, and only while they are finite, within 0..1
/// and fresh. Once it has been `Released` zeros are sent in every step, in every state and whatever the
/// interlock's profile: motor controllers on a bus have no pilot to hand over to. The word that motors may
/// turn is taken back in the same step.
class StandMotors {
 public:
  /// Commands older than this are zeros.
  static constexpr Time kGreatestAge = std::chrono::milliseconds(50);

  /// @param bus   outlives this
  /// @param gate  stepped by somebody else before this; outlives this
  StandMotors(const can::EscControllerParams& params, transport::FrameBus& bus, const InterlockStatus& gate,
              Time start);
  /// Ends in zeros.
  ~StandMotors();
  StandMotors(const StandMotors&) = delete;
  StandMotors& operator=(const StandMotors&) = delete;

  /// What the unit has last wanted of the motors. @param stamp  when it said so
  void want(std::span<const double> throttles, Time stamp);

  /// Takes what arrived, sends one command for all motors. Call it in every control period.
  void step(Time now);

  /// How many commands above zero did not leave.
  std::uint64_t refused() const { return refused_; }
  const can::EscController& controller() const { return controller_; }

 private:
  bool sound() const;
  void stop(Time now);

  can::EscController controller_;
  const InterlockStatus& gate_;
  std::vector<double> zeros_;
  std::vector<double> wanted_;
  Time wanted_at_ = Time::min();
  Time now_;
  std::uint64_t refused_ = 0;
  bool opened_ = false;
};

}  // namespace ironbird::hil_bridge
