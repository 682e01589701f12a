#include "hil_bridge/hil_fcu/can_motors.hpp"

#include <algorithm>

#include "simulator/types/bounds.hpp"

namespace ironbird::hil_bridge {

CanMotors::CanMotors(const can::EscBusParams& params, const simulator::RotorParams& rotor,
                     transport::FrameBus& bus, Time start, transport::BusFault* fault,
                     const EscHeatParams& heat)
    : rotor_(rotor),
      heat_(heat),
      bus_(bus),
      fault_(fault),
      escs_(params, bus, start),
      readings_(static_cast<std::size_t>(params.count)),
      before_(start) {
  simulator::check_bounds(heat_, "esc_heat");
  for (can::EscReading& reading : readings_) reading.temperature = heat_.ambient;
}

simulator::RotorCommands CanMotors::step(const simulator::Truth& truth, Time now) {
  const double dt = std::chrono::duration<double>(now - before_).count();
  before_ = now;
  const std::size_t count = std::min(readings_.size(), truth.rotor_speed.size());
  for (std::size_t motor = 0; motor < count; ++motor) read(motor, truth, dt);
  if (fault_ != nullptr) fault_->advance(now);
  escs_.step(readings_, now);
  simulator::RotorCommands commands;
  for (std::size_t motor = 0; motor < count; ++motor) {
    status_.motors[motor] = escs_.commands()[motor];
    commands.throttle[motor] = status_.motors[motor].throttle;
  }
  status_.state = bus_.state();
  status_.frames = bus_.counters();
  return commands;
}

/// What the controller measures while it still does what it was told last.
void CanMotors::read(std::size_t motor, const simulator::Truth& truth, double dt) {
  can::EscReading& reading = readings_[motor];
  const double throttle = status_.motors[motor].throttle;
  const double speed = truth.rotor_speed[motor];
  const double drive = throttle * truth.battery_voltage;                                                 // V
  const double through_motor = throttle > 0.0 ? (drive - rotor_.K_V * speed) / rotor_.resistance : 0.0;  // A
  reading.speed = speed;
  reading.voltage = truth.battery_voltage;
  reading.current = throttle * through_motor;
  const double loss = heat_.resistance * through_motor * through_motor;  // W
  const double warm = heat_.ambient + heat_.thermal_resistance * loss;   // K, in the end
  reading.temperature += std::min(dt / heat_.time_constant, 1.0) * (warm - reading.temperature);
  reading.health = reading.temperature >= heat_.warning ? can::kHealthWarning : can::kHealthOk;
}

}  // namespace ironbird::hil_bridge
