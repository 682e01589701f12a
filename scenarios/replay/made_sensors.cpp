#include "scenarios/replay/made_sensors.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/degrees.hpp"
#include "scenarios/config/shortest.hpp"
#include "scenarios/replay/arrivals.hpp"
#include "scenarios/replay/truth_track.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Arrival;
using hil_bridge::Time;
using simulator::Truth;
namespace rosflight = hil_bridge::rosflight;

rosflight::RosflightGnss message_of(const simulator::GnssReading& reading) {
  rosflight::RosflightGnss fix;
  fix.rosflight_timestamp = wire_stamp(reading.taken);
  fix.lat = reading.latitude * kDegreesPerRadian;
  fix.lon = reading.longitude * kDegreesPerRadian;
  fix.height = static_cast<float>(reading.altitude);
  fix.vel_n = static_cast<float>(reading.v_NB_N.x());
  fix.vel_e = static_cast<float>(reading.v_NB_N.y());
  fix.vel_d = static_cast<float>(reading.v_NB_N.z());
  fix.h_acc = static_cast<float>(reading.horizontal_accuracy);
  fix.v_acc = static_cast<float>(reading.vertical_accuracy);
  fix.s_acc = static_cast<float>(reading.speed_accuracy);
  fix.fix_type = static_cast<std::uint8_t>(reading.fix);
  fix.num_sat = static_cast<std::uint8_t>(reading.satellites);
  return fix;
}

rosflight::SmallBaro message_of(const simulator::BaroReading& reading) {
  return {0.0F, static_cast<float>(reading.pressure), static_cast<float>(reading.temperature)};
}

rosflight::SmallMag message_of(const simulator::MagReading& reading) {
  const Eigen::Vector3f m = reading.m_B.cast<float>();
  return {m.x(), m.y(), m.z()};
}

/// "white 0.3 m, slow 1.3 m over 1350 s": the errors that there are.
std::string errors_text(const simulator::AxisErrorParams& errors, const std::string& unit, double factor) {
  const auto number = [factor](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", factor * value);
    return std::string(text);
  };
  std::string text;
  const auto add = [&](double value, const std::string& what) {
    if (value > 0.0) text += (text.empty() ? "" : ", ") + what;
  };
  add(errors.noise_sigma, "white " + number(errors.noise_sigma) + " " + unit);
  add(errors.noise_density, "white " + number(errors.noise_density) + " " + unit + "/sqrt(Hz)");
  add(errors.instability_sigma, "slow " + number(errors.instability_sigma) + " " + unit + " over " +
                                    shortest(errors.instability_time_constant) + " s");
  add(errors.turn_on_sigma, "constant " + number(errors.turn_on_sigma) + " " + unit);
  add(errors.random_walk, "walk " + number(errors.random_walk) + " " + unit + "/sqrt(s)");
  return text.empty() ? "no noise" : text;
}

class SensorMaker {
 public:
  SensorMaker(const MadeSensors& wanted, const RecordedEstimate& truth, const simulator::SensorSite& site,
              Time end)
      : wanted_(wanted), truth_(truth), track_(truth), site_(site), end_(end) {}

  MadeMessages make() {
    if (is_wanted(wanted_.gnss)) make_gnss(*wanted_.gnss);
    if (is_wanted(wanted_.barometer)) make_barometer(*wanted_.barometer);
    if (is_wanted(wanted_.magnetometer)) make_magnetometer(*wanted_.magnetometer);
    return std::move(made_);
  }

 private:
  template <class Params>
  static bool is_wanted(const std::optional<Params>& params) {
    return params && params->timing.enabled;
  }

  void make_gnss(const simulator::GnssParams& params) {
    const std::size_t count = make<simulator::Gnss>(params, [this](Time when) {
      return moment(when, track_.position(when), track_.velocity(when), autopilot::Quaternion::Identity());
    });
    remark("GNSS fixes", count, params.timing,
           errors_text(params.horizontal, "m", 1.0) + " horizontally; " +
               errors_text(params.vertical, "m", 1.0) + " vertically; " +
               errors_text(params.velocity, "m/s", 1.0) + " of velocity");
  }
  void make_barometer(const simulator::BarometerParams& params) {
    const std::size_t count = make<simulator::Barometer>(params, [this](Time when) {
      return moment(when, track_.position(when), autopilot::Vector3::Zero().eval(),
                    autopilot::Quaternion::Identity());
    });
    remark("barometer", count, params.timing, errors_text(params.error, "Pa", 1.0));
  }
  void make_magnetometer(const simulator::MagnetometerParams& params) {
    constexpr double kMicro = 1e6;
    const std::size_t count = make<simulator::Magnetometer>(params, [this](Time when) {
      return moment(when, autopilot::Vector3::Zero().eval(), autopilot::Vector3::Zero().eval(),
                    track_.attitude(when));
    });
    remark("magnetometer", count, params.timing, errors_text(params.error, "uT", kMicro));
  }

  /// What the models may ask of the truth at one time; nothing where one of these is not known.
  static std::optional<Truth> moment(Time when, const std::optional<autopilot::Vector3>& p_NB_N,
                                     const std::optional<autopilot::Vector3>& v_NB_N,
                                     const std::optional<autopilot::Quaternion>& q_NB) {
    if (!p_NB_N || !v_NB_N || !q_NB) return std::nullopt;
    Truth truth;
    truth.stamp = when;
    truth.p_NB_N = *p_NB_N;
    truth.v_NB_N = *v_NB_N;
    truth.q_NB = *q_NB;
    return truth;
  }

  /// @param known  what is true at a time, or nothing. @return how many samples were made
  template <class Sensor, class Params, class Known>
  std::size_t make(const Params& params, Known&& known) {
    const Time period = from_seconds(1.0 / params.timing.rate);
    const Time latency = from_seconds(params.timing.latency);
    Sensor sensor(params, site_, to_seconds(period), wanted_.seed);
    std::size_t count = 0;
    for (Time taken = period; taken + latency <= end_; taken += period) {
      const std::optional<Truth> truth = known(taken);
      if (!truth) continue;
      made_.messages.push_back(
          {taken + latency, message_of(sensor.measure(*truth, taken, simulator::FaultState{}, true))});
      ++count;
    }
    return count;
  }

  void remark(const std::string& sensor, std::size_t count, const simulator::TimingParams& timing,
              const std::string& errors) {
    made_.names.push_back(sensor);
    made_.remarks.push_back(sensor + " made from " + truth_.name +
                            ", not recorded: " + std::to_string(count) + " at " + shortest(timing.rate) +
                            " Hz, " + errors + ", seed " + std::to_string(wanted_.seed));
  }

  const MadeSensors& wanted_;
  const RecordedEstimate& truth_;
  TruthTrack track_;
  const simulator::SensorSite& site_;
  Time end_;
  MadeMessages made_;
};

}  // namespace

MadeMessages make_sensors(const MadeSensors& wanted, const RecordedEstimate& truth,
                          const simulator::SensorSite& site, Time end) {
  return SensorMaker(wanted, truth, site, end).make();
}

}  // namespace ironbird::scenarios
