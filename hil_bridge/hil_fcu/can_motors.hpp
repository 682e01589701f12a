#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hil_bridge/can/esc_bus.hpp"
#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/transport/bus_fault.hpp"
#include "simulator/types/rotor_commands.hpp"
#include "simulator/types/truth.hpp"
#include "simulator/vehicle/rotor.hpp"

namespace ironbird::hil_bridge {

/// How a motor controller warms. Estimated, for one of 40 A in the wind of its propeller.
struct EscHeatParams {
  double resistance = 0.004;
  double thermal_resistance = 3.0;
  double time_constant = 40.0;
  double ambient = 293.15;
  double warning = 373.15;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("resistance", self.resistance, "ohm", "of its switches", 0.0, 1.0);
    visit("thermal_resistance", self.thermal_resistance, "K/W", "to the air", 0.0, 100.0);
    visit("time_constant", self.time_constant, "s", "of warming", 0.1, 1e4);
    visit("ambient", self.ambient, "K", "temperature of the air", 200.0, 350.0);
    visit("warning", self.warning, "K", "from here on it warns", 250.0, 500.0);
  }
};

/// What goes on at the bench's end of the bus.
struct CanMotorsStatus {
  transport::BusState state = transport::BusState::kActive;
  transport::BusCounters frames;
  std::array<can::EscCommand, simulator::kMaxRotors> motors{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("state", self.state, "1", "of the controller");
    visit("frames", self.frames, "", "that went through this end");
    visit("motors", self.motors, "", "what each has to do");
  }
};

/// The bench plays the motor controllers of a vehicle on a CAN bus: the unit's commands turn the simulated
/// rotors, and each controller reports speed, voltage, current and temperature of its own.
class CanMotors {
 public:
  /// @param rotor  of the vehicle
  /// @param bus    the bench's end; outlives this
  /// @param fault  the same, when it has faults: then it is told the time; outlives this
  /// @throws std::invalid_argument naming key, value and bound
  CanMotors(const can::EscBusParams& params, const simulator::RotorParams& rotor, transport::FrameBus& bus,
            Time start, transport::BusFault* fault = nullptr, const EscHeatParams& heat = {});

  /// Takes what arrived, reports the rotors as they are. @return what the rotors are told until the next step
  simulator::RotorCommands step(const simulator::Truth& truth, Time now);

  const CanMotorsStatus& status() const { return status_; }
  const can::EscReading& reading(std::size_t motor) const { return readings_[motor]; }
  /// The oldest event of the bus that nobody has taken.
  std::optional<transport::BusEvent> take_event() { return bus_.take_event(); }

 private:
  void read(std::size_t motor, const simulator::Truth& truth, double dt);

  simulator::RotorParams rotor_;
  EscHeatParams heat_;
  transport::FrameBus& bus_;
  transport::BusFault* fault_;
  can::EscBus escs_;
  std::vector<can::EscReading> readings_;
  CanMotorsStatus status_;
  Time before_;
};

}  // namespace ironbird::hil_bridge
