#include "simulator/sensors/sensor_suite.hpp"

#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "simulator/types/bounds.hpp"

namespace ironbird::simulator {

namespace {

/// Sets every number of a reading to NaN.
struct Spoil {
  template <class Value>
  void operator()(const char* /*name*/, Value& value, const char* /*unit*/, const char* /*meaning*/) const {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    if constexpr (std::is_same_v<Value, double>) value = kNan;
    if constexpr (std::is_same_v<Value, Vector3>) value.setConstant(kNan);
  }
};

template <class Sensor, class Params>
std::optional<SensorChannel<Sensor>> make_channel(const Params& params, const SensorSite& site, Time tick,
                                                  std::uint64_t seed, const std::string& path) {
  if (!params.timing.enabled) return std::nullopt;
  const Time period = sample_period(params.timing.rate, tick, path + ".timing.rate");
  const Time latency = whole_ticks(params.timing.latency, tick);
  constexpr std::int64_t kLongest = DelayLine<typename Sensor::Reading>::kCapacity - 1;
  if (latency / period >= kLongest) {
    std::ostringstream message;
    message << path << ".timing.latency = " << params.timing.latency << " s, must be less than "
            << seconds(kLongest * period) << " s at " << params.timing.rate << " Hz";
    throw std::invalid_argument(message.str());
  }
  return SensorChannel<Sensor>(Sensor(params, site, seconds(period), seed), period, latency);
}

template <class Channel, class Reading>
void sample_one(std::optional<Channel>& channel, const Truth& truth, Time now, const FaultState& faults,
                const Outage& outage, bool armed, std::optional<Reading>& out) {
  if (channel) channel->sample(truth, now, faults, outage, armed, out);
}

}  // namespace

template <class Sensor>
void SensorChannel<Sensor>::sample(const Truth& truth, Time now, const FaultState& faults,
                                   const Outage& outage, bool armed,
                                   std::optional<typename Sensor::Reading>& out) {
  if (clock_.due(now)) {
    typename Sensor::Reading reading = sensor_.measure(truth, now, faults, armed);
    if (outage.non_finite) Sensor::Reading::describe(reading, Spoil());
    if (!outage.dropout) {
      if (latency_ == Time::zero()) {
        out = reading;
        return;
      }
      line_.push(now + latency_, reading);
    }
  }
  line_.pop(now, out);
}

SensorSuite::SensorSuite(const SensorSuiteParams& params, const SensorSite& site, Time tick,
                         std::uint64_t seed) {
  if (tick <= Time::zero())
    throw std::invalid_argument("tick = " + std::to_string(tick.count()) + " ns, must be > 0");
  check_bounds(params, "sensors");
  if (params.range_finder.maximum <= params.range_finder.minimum) {
    std::ostringstream message;
    message << "sensors.range_finder.maximum = " << params.range_finder.maximum
            << " m, must be > minimum = " << params.range_finder.minimum << " m";
    throw std::invalid_argument(message.str());
  }
  imu_ = make_channel<Imu>(params.imu, site, tick, seed, "sensors.imu");
  magnetometer_ = make_channel<Magnetometer>(params.magnetometer, site, tick, seed, "sensors.magnetometer");
  barometer_ = make_channel<Barometer>(params.barometer, site, tick, seed, "sensors.barometer");
  gnss_ = make_channel<Gnss>(params.gnss, site, tick, seed, "sensors.gnss");
  range_finder_ = make_channel<RangeFinder>(params.range_finder, site, tick, seed, "sensors.range_finder");
  airspeed_ = make_channel<Airspeed>(params.airspeed, site, tick, seed, "sensors.airspeed");
  battery_ = make_channel<BatteryMonitor>(params.battery, site, tick, seed, "sensors.battery");
}

void SensorSuite::sample(const Truth& truth, Time now, const FaultState& faults, Readings& out) {
  const Outage none;
  sample_one(imu_, truth, now, faults, faults.imu, armed_, out.imu);
  sample_one(magnetometer_, truth, now, faults, faults.mag, armed_, out.mag);
  sample_one(barometer_, truth, now, faults, faults.baro, armed_, out.baro);
  sample_one(gnss_, truth, now, faults, faults.gnss, armed_, out.gnss);
  sample_one(range_finder_, truth, now, faults, none, armed_, out.range);
  sample_one(airspeed_, truth, now, faults, none, armed_, out.airspeed);
  sample_one(battery_, truth, now, faults, none, armed_, out.battery);
}

}  // namespace ironbird::simulator
