#include "scenarios/bench/make_guard.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::virtual_fcu::kParameterTable;
using hil_bridge::virtual_fcu::ParameterInfo;
using hil_bridge::virtual_fcu::ParameterType;

constexpr double kSeaLevelDensity = 1.225;  // kg/m^3
constexpr double kGreatestRate = 35.0;      // rad/s, what the gyro of every supported board can measure
constexpr double kGreatestAngle = std::numbers::pi / 2.0;
constexpr int kPeriodsOfAge = 2;

double full_voltage(const simulator::BatteryParams& battery) {
  return battery.constant_voltage > 0.0 ? battery.constant_voltage
                                        : battery.cells * battery.cell_voltage.back();
}

/// Speed at which motor and air balance under this voltage, rad/s. Small Unmanned Aircraft, section 4.3.
double greatest_speed(const simulator::RotorParams& rotor, double voltage) {
  const double drag = kSeaLevelDensity * std::pow(rotor.diameter, 5) * rotor.CQ[0] /
                      (4.0 * std::numbers::pi * std::numbers::pi);  // N m s^2
  const double a = drag * rotor.resistance / rotor.K_V;
  const double b = rotor.K_V;
  const double c = rotor.no_load_current * rotor.resistance - voltage;
  return a > 0.0 ? (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a) : -c / b;
}

const ParameterInfo& info_of(std::string_view name) {
  return *std::find_if(kParameterTable.begin(), kParameterTable.end(), [&](const ParameterInfo& info) {
    return hil_bridge::rosflight::text_of(info.name) == name;
  });
}

}  // namespace

hil_bridge::CommandLimits command_limits(const Scenario& scenario) {
  const simulator::RotorParams& rotor = scenario.vehicle.rotor;
  const double turns =
      greatest_speed(rotor, full_voltage(scenario.vehicle.battery)) / (2.0 * std::numbers::pi);
  const double thrust = kSeaLevelDensity * std::pow(rotor.diameter, 4) * rotor.CT[0] * turns * turns;
  const double drag = kSeaLevelDensity * std::pow(rotor.diameter, 5) * rotor.CQ[0] * turns * turns;
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
  for (const simulator::RotorMount& mount : scenario.vehicle.rotors) {
    roll += 0.5 * thrust * std::abs(mount.position.y());
    pitch += 0.5 * thrust * std::abs(mount.position.x());
    yaw += 0.5 * drag;
  }
  return {.thrust = thrust * static_cast<double>(scenario.vehicle.rotors.size()),
          .torque = std::max({roll, pitch, yaw}),
          .angle = kGreatestAngle,
          .rate = kGreatestRate,
          .greatest_age = kPeriodsOfAge * scenario.fcu.tick + scenario.fcu.downlink_latency};
}

int unit_parameter(const Scenario& scenario, std::string_view name) {
  for (const auto& given : scenario.fcu.parameters) {
    if (given.name == name) return static_cast<int>(given.value);
  }
  return std::bit_cast<std::int32_t>(info_of(name).default_bits);
}

bool has_override_switches(const Scenario& scenario) {
  return hil_bridge::switches_mapped([&](std::string_view name) { return unit_parameter(scenario, name); });
}

hil_bridge::InterlockConfig interlock_config(const Scenario& scenario) {
  return {.profile = scenario.interlock.profile,
          .limits = command_limits(scenario),
          .unit_timeout = std::chrono::milliseconds(unit_parameter(scenario, "OFFBOARD_TIMEOUT"))};
}

std::vector<hil_bridge::ParameterRecord> wanted_parameters(const Scenario& scenario) {
  std::vector<hil_bridge::ParameterRecord> records;
  for (const auto& given : scenario.fcu.parameters) {
    const bool real = info_of(given.name).type == ParameterType::kReal;
    const std::uint32_t bits =
        real ? std::bit_cast<std::uint32_t>(static_cast<float>(given.value))
             : std::bit_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(given.value)));
    records.push_back({given.name, real ? hil_bridge::kRealParameter : hil_bridge::kIntegerParameter, bits});
  }
  return records;
}

}  // namespace ironbird::scenarios
