#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/airspeed.hpp"
#include "simulator/sensors/barometer.hpp"
#include "simulator/sensors/battery_monitor.hpp"
#include "simulator/sensors/gnss.hpp"
#include "simulator/sensors/imu.hpp"
#include "simulator/sensors/magnetometer.hpp"
#include "simulator/sensors/range_finder.hpp"
#include "simulator/sensors/schedule.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

/// Every sensor that a vehicle can carry. The defaults are perfect sensors at usual rates.
struct SensorSuiteParams {
  ImuParams imu;
  MagnetometerParams magnetometer;
  BarometerParams barometer;
  GnssParams gnss;
  RangeFinderParams range_finder;
  AirspeedParams airspeed;
  BatteryMonitorParams battery;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("imu", self.imu, "", "inertial measurement unit");
    visit("magnetometer", self.magnetometer, "", "magnetometer");
    visit("barometer", self.barometer, "", "barometer");
    visit("gnss", self.gnss, "", "satellite receiver");
    visit("range_finder", self.range_finder, "", "range finder");
    visit("airspeed", self.airspeed, "", "pitot tube");
    visit("battery", self.battery, "", "battery monitor");
  }
};

/// One sensor with its clock and the readings that are still on their way.
template <class Sensor>
class SensorChannel {
 public:
  SensorChannel(Sensor sensor, Time period, Time latency)
      : sensor_(std::move(sensor)), clock_(period), latency_(latency) {}

  /// Samples if due and hands over what arrives at `now`.
  void sample(const Truth& truth, Time now, const FaultState& faults, const Outage& outage, bool armed,
              std::optional<typename Sensor::Reading>& out);

 private:
  Sensor sensor_;
  SampleClock clock_;
  Time latency_;
  DelayLine<typename Sensor::Reading> line_;
};

/// The vehicle's sensors.
///
/// A dropout swallows samples that were taken, so it changes no later noise. Every noise source has its own
/// stream, named "sensors/<sensor>/...": removing a sensor leaves the others as they were, to the bit.
class SensorSuite {
 public:
  /// @param tick  of the simulation: `sample` is called at its multiples; > 0
  /// @throws std::invalid_argument when a parameter is outside its bounds, a period is not a whole number of
  /// ticks (the message names the two nearest rates) or a latency has too many samples on their way
  SensorSuite(const SensorSuiteParams& params, const SensorSite& site, Time tick, std::uint64_t seed);

  /// Samples the sensors due at `now` and puts what arrives at `now` into `out`; leaves the rest of `out` as
  /// it was.
  /// @param now  later than in the call before
  void sample(const Truth& truth, Time now, const FaultState& faults, Readings& out);

  /// Tells the sensors whether the FCU lets the motors turn: `ImuParams::noise_only_when_armed` asks.
  void set_armed(bool armed) { armed_ = armed; }

 private:
  std::optional<SensorChannel<Imu>> imu_;
  std::optional<SensorChannel<Magnetometer>> magnetometer_;
  std::optional<SensorChannel<Barometer>> barometer_;
  std::optional<SensorChannel<Gnss>> gnss_;
  std::optional<SensorChannel<RangeFinder>> range_finder_;
  std::optional<SensorChannel<Airspeed>> airspeed_;
  std::optional<SensorChannel<BatteryMonitor>> battery_;
  bool armed_ = false;
};

}  // namespace ironbird::simulator
