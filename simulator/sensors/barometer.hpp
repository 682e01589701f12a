#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "simulator/environment/air.hpp"
#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/error_model.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/sensors/timing.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

/// Where the undisturbed pressure comes from.
enum class PressureModel : std::uint8_t {
  kEnvironment,  ///< the environment's air: U.S. Standard Atmosphere 1976, shifted to the day
  kReference  ///< 101325 (1 - 2.25694e-5 h)^5.2553, h in m above mean sea level, as the reference simulator
};

constexpr std::array<std::pair<PressureModel, std::string_view>, 2> enumerators(PressureModel) {
  return {{{PressureModel::kEnvironment, "environment"}, {PressureModel::kReference, "reference"}}};
}

struct BarometerParams {
  TimingParams timing{.rate = 50.0};
  PressureModel model = PressureModel::kEnvironment;
  double rotor_wash = 0.0;
  double wind_coefficient = 0.0;
  double temperature = 300.15;
  ScalarErrorParams<PressureUnits> error;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("timing", self.timing, "", "when it samples");
    visit("model", self.model, "1", "environment or reference");
    visit("rotor_wash", self.rotor_wash, "Pa/(rad/s)^2", "pressure change per squared rotor speed, summed",
          -1.0, 1.0);
    visit("wind_coefficient", self.wind_coefficient, "1",
          "pressure change over the dynamic pressure of the air that passes", -2.0, 2.0);
    visit("temperature", self.temperature, "K", "of the chip", 200.0, 400.0);
    visit("error", self.error, "", "errors of the chip");
  }
};

/// Static pressure at the vehicle's centre of mass, disturbed by its own air.
class Barometer {
 public:
  using Reading = BaroReading;

  Barometer(const BarometerParams& params, const SensorSite& site, double period, std::uint64_t seed);

  /// The reading at `now`.
  BaroReading measure(const Truth& truth, Time now, const FaultState& faults, bool armed);

 private:
  double still_pressure(double height) const;

  BarometerParams params_;
  double home_altitude_;
  Air air_;
  ScalarError error_;
};

}  // namespace ironbird::simulator
