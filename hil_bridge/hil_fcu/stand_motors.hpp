#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hil_bridge/can/esc_controller.hpp"
#include "hil_bridge/interlock/interlock.hpp"
#include "simulator/types/rotor_commands.hpp"

namespace ironbird::hil_bridge {

/// What one motor controller on the stand tells.
struct StandMotor {
  bool ready = false;
  double speed = 0.0;
  double voltage = 0.0;
  double current = 0.0;
  double temperature = 0.0;
  std::uint32_t errors = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("ready", self.ready, "1", "its node lives, does not complain, and reports");
    visit("speed", self.speed, "rad/s", "negative backward; this and the rest as last reported");
    visit("voltage", self.voltage, "V", "of the supply");
    visit("current", self.current, "A", "from the supply");
    visit("temperature", self.temperature, "K", "of the controller");
    visit("errors", self.errors, "1", "since it started");
  }
};

/// What goes on on the stand's bus.
struct StandStatus {
  transport::BusState state = transport::BusState::kActive;
  transport::BusCounters frames;
  bool turning = false;
  std::uint64_t refused = 0;
  std::array<StandMotor, simulator::kMaxRotors> motors{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("state", self.state, "1", "of the controller");
    visit("frames", self.frames, "", "that went through this end");
    visit("turning", self.turning, "1", "the last command was the unit's; false: zeros, or none");
    visit("refused", self.refused, "1", "commands above zero that did not leave");
    visit("motors", self.motors, "", "what each tells");
  }
};

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

  const StandStatus& status() const { return status_; }
  const can::EscController& controller() const { return controller_; }
  /// The oldest event of the bus that nobody has taken.
  std::optional<transport::BusEvent> take_event() { return bus_.take_event(); }

 private:
  bool sound() const;
  void stop(Time now);
  void look(Time now);

  transport::FrameBus& bus_;
  can::EscController controller_;
  const InterlockStatus& gate_;
  std::vector<double> zeros_;
  std::vector<double> wanted_;
  Time wanted_at_ = Time::min();
  Time now_;
  StandStatus status_;
  bool opened_ = false;
};

}  // namespace ironbird::hil_bridge
