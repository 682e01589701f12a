#include "simulator/vehicle/battery.hpp"

#include <algorithm>

namespace ironbird::simulator {

Battery::Battery(const BatteryParams& params)
    : params_(params),
      charge_(params.initial_charge),
      resistance_(params.constant_voltage > 0.0 ? 0.0 : params.resistance) {
  find_open_voltage();
}

void Battery::draw(double current, double dt) {
  charge_used_ += current * dt;
  set_charge(charge_ - current * dt / params_.capacity);
}

void Battery::set_charge(double fraction) {
  charge_ = std::clamp(fraction, -params_.collapse, 1.0);
  find_open_voltage();
}

void Battery::find_open_voltage() {
  if (params_.constant_voltage > 0.0) {
    open_voltage_ = params_.constant_voltage;
    return;
  }
  const auto& table = params_.cell_voltage;
  if (charge_ < 0.0) {
    open_voltage_ = params_.cells * table[0] * (1.0 + charge_ / params_.collapse);
    return;
  }
  const int last = static_cast<int>(table.size()) - 1;
  const int below = std::min(static_cast<int>(charge_ * last), last - 1);
  const double share = charge_ * last - below;
  open_voltage_ = params_.cells * (table[below] + share * (table[below + 1] - table[below]));
}

}  // namespace ironbird::simulator
