#include "scenarios/replay/px4_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "autopilot/math/standard_atmosphere.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/magnetic_field.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Vector3;
using hil_bridge::Arrival;
using hil_bridge::Time;
namespace rosflight = hil_bridge::rosflight;

constexpr double kTeslaPerGauss = 1e-4;
constexpr double kZeroCelsius = 273.15;  // K
constexpr double kUsualDelay = 0.11;     // s, PX4's own default
constexpr double kLongestDelay = 1.0;    // s
// What a receiver is taken to mean that does not tell its accuracy: m, m, m/s.
constexpr float kUsualHorizontal = 2.0F;
constexpr float kUsualVertical = 4.0F;
constexpr float kUsualSpeed = 0.5F;
constexpr float kUsualTemperature = 288.15F;  // K

float or_else(double value, float otherwise) {
  return std::isfinite(value) ? static_cast<float>(value) : otherwise;
}

/// The wire's word for PX4's kind of fix.
std::uint8_t fix_type(std::int64_t px4) {
  using autopilot::GnssFix;
  switch (px4) {
    case 2:
      return static_cast<std::uint8_t>(GnssFix::kFix2D);
    case 3:
    case 4:
      return static_cast<std::uint8_t>(GnssFix::kFix3D);
    case 5:
      return static_cast<std::uint8_t>(GnssFix::kRtkFloat);
    case 6:
      return static_cast<std::uint8_t>(GnssFix::kRtkFixed);
    case 8:
      return static_cast<std::uint8_t>(GnssFix::kDeadReckoning);
    default:
      return static_cast<std::uint8_t>(GnssFix::kNone);
  }
}

/// Reads fixes, whichever layout they have.
class GnssReader {
 public:
  explicit GnssReader(const Px4Records& fixes)
      : fixes_(fixes),
        in_degrees_(fixes.find("latitude_deg").has_value()),
        latitude_(fixes.find(in_degrees_ ? "latitude_deg" : "lat")),
        longitude_(fixes.find(in_degrees_ ? "longitude_deg" : "lon")),
        altitude_(fixes.find(in_degrees_ ? "altitude_msl_m" : "alt")),
        v_N_(fixes.find("vel_n_m_s")),
        v_E_(fixes.find("vel_e_m_s")),
        v_D_(fixes.find("vel_d_m_s")),
        eph_(fixes.find("eph")),
        epv_(fixes.find("epv")),
        speed_(fixes.find("s_variance_m_s")),
        satellites_(fixes.find("satellites_used")),
        kind_(fixes.find("fix_type")),
        velocity_valid_(fixes.find("vel_ned_valid")),
        utc_(fixes.find("time_utc_usec")) {}

  rosflight::RosflightGnss fix(std::size_t k) const {
    rosflight::RosflightGnss fix;
    fix.lat = (in_degrees_ ? 1.0 : 1e-7) * fixes_.number(k, latitude_);
    fix.lon = (in_degrees_ ? 1.0 : 1e-7) * fixes_.number(k, longitude_);
    fix.height = static_cast<float>((in_degrees_ ? 1.0 : 1e-3) * fixes_.number(k, altitude_));
    fix.vel_n = static_cast<float>(fixes_.number(k, v_N_));
    fix.vel_e = static_cast<float>(fixes_.number(k, v_E_));
    fix.vel_d = static_cast<float>(fixes_.number(k, v_D_));
    fix.h_acc = or_else(fixes_.number(k, eph_), kUsualHorizontal);
    fix.v_acc = or_else(fixes_.number(k, epv_), kUsualVertical);
    fix.s_acc = or_else(fixes_.number(k, speed_), kUsualSpeed);
    fix.num_sat = static_cast<std::uint8_t>(std::clamp<std::int64_t>(fixes_.integer(k, satellites_), 0, 255));
    fix.fix_type = fix_type(fixes_.integer(k, kind_));
    return fix;
  }
  bool has_velocity(std::size_t k) const {
    return !velocity_valid_ || fixes_.integer(k, velocity_valid_) != 0;
  }
  /// s since 1970, where the receiver knows it.
  std::optional<double> unix_time(std::size_t k) const {
    constexpr std::int64_t kEarliest = 946'684'800'000'000;  // us, the year 2000
    constexpr std::int64_t kLatest = 4'102'444'800'000'000;  // 2100
    const std::int64_t us = fixes_.integer(k, utc_);
    return us > kEarliest && us < kLatest ? std::optional(1e-6 * static_cast<double>(us)) : std::nullopt;
  }

 private:
  const Px4Records& fixes_;
  bool in_degrees_;
  std::optional<UlogPlace> latitude_, longitude_, altitude_, v_N_, v_E_, v_D_, eph_, epv_, speed_,
      satellites_, kind_, velocity_valid_, utc_;
};

bool is_on_earth(const rosflight::RosflightGnss& fix) {
  return std::abs(fix.lat) <= 90.0 && std::abs(fix.lon) <= 180.0 && std::isfinite(fix.height) &&
         std::isfinite(fix.vel_n + fix.vel_e + fix.vel_d);
}

bool is_usable(const rosflight::RosflightGnss& fix) {
  return autopilot::is_usable(static_cast<autopilot::GnssFix>(fix.fix_type));
}

void find_delay(Px4Log& log, std::optional<double> named, Px4Flight& flight) {
  flight.gnss_delay = named.value_or(kUsualDelay);
  flight.gnss_delay_source = named ? "as named" : "PX4's own default";
  const auto told = named ? std::nullopt : log.file.parameter("EKF2_GPS_DELAY");  // ms
  if (!told) return;
  const double delay = 1e-3 * *told;
  if (delay >= 0.0 && delay <= kLongestDelay) {
    flight.gnss_delay = delay;
    flight.gnss_delay_source = "EKF2_GPS_DELAY of the log";
    return;
  }
  log.remark("its EKF2_GPS_DELAY of " + std::to_string(*told) +
             " ms cannot be: fixes are taken to be 110 ms old");
}

/// Samples of one magnetometer, tesla.
std::vector<Vector3> field_of(const Px4Records& mag) {
  std::vector<Vector3> samples;
  const auto field = mag.find("magnetometer_ga");
  for (std::size_t k = 0; field && k < mag.size(); ++k) {
    const Vector3 m_B = kTeslaPerGauss * mag.vector(k, field);
    if (m_B.allFinite() && m_B.norm() > 0.0) samples.push_back(m_B);
  }
  return samples;
}

// How far the strength is from the earth's, and how it spreads: both come from iron and currents nearby.
MagCandidate candidate(int instance, const Px4Records& mag, const std::optional<MagneticField>& earth) {
  MagCandidate found;
  found.instance = instance;
  const std::vector<Vector3> samples = field_of(mag);
  found.samples = samples.size();
  if (samples.empty()) {
    found.misfit = std::numeric_limits<double>::infinity();
    return found;
  }
  double sum = 0.0;
  double squares = 0.0;
  for (const Vector3& m_B : samples) {
    sum += m_B.norm();
    squares += m_B.squaredNorm();
  }
  const auto count = static_cast<double>(samples.size());
  found.strength = sum / count;
  found.spread = std::sqrt(std::max(0.0, squares / count - found.strength * found.strength)) / found.strength;
  const double offset = earth ? found.strength / earth->strength - 1.0 : 0.0;
  found.misfit = std::hypot(offset, found.spread);
  return found;
}

/// @return nothing when there is none
std::optional<int> choose(const std::vector<MagCandidate>& mags, std::optional<int> named,
                          const std::string& log) {
  if (!named) {
    const auto best = std::min_element(
        mags.begin(), mags.end(),
        [](const MagCandidate& one, const MagCandidate& other) { return one.misfit < other.misfit; });
    return best != mags.end() && best->samples > 0 ? std::optional(best->instance) : std::nullopt;
  }
  std::string there;
  bool is_mute = false;
  for (const MagCandidate& mag : mags) {
    if (mag.samples == 0) {
      is_mute = is_mute || mag.instance == *named;
      continue;
    }
    if (mag.instance == *named) return named;
    there += (there.empty() ? "" : ", ") + std::to_string(mag.instance);
  }
  const std::string number = std::to_string(*named);
  const std::string what =
      is_mute ? "magnetometer " + number + " tells no field in any sample" : "has no magnetometer " + number;
  throw UserError(log + ": " + what + (there.empty() ? "; the log has no other" : "; there are: " + there));
}

/// Why the magnetometer that was taken was taken.
std::string mag_source(const Px4Flight& flight, bool named) {
  if (named) return "as named";
  if (!flight.mag) return "the log has none";
  const auto tells = [](const MagCandidate& mag) { return mag.samples > 0; };
  if (std::count_if(flight.mags.begin(), flight.mags.end(), tells) == 1) return "the only one of the log";
  return flight.first_fix ? "it fits the earth's field best, strength and spread together"
                          : "its strength spreads least; there is no place to ask for the earth's";
}

}  // namespace

std::vector<Arrival> read_px4_gnss(Px4Log& log, std::optional<double> delay, Px4Flight& flight) {
  const Px4Records fixes = log.first_of({"vehicle_gps_position", "sensor_gps"});
  const GnssReader reader(fixes);
  find_delay(log, delay, flight);
  const Time age(std::llround(flight.gnss_delay * 1e9));
  std::vector<Arrival> messages;
  std::size_t without_velocity = 0;
  std::size_t no_numbers = 0;
  bool any_usable = false;
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    const Time when = fixes.published(k);
    // Of one that was measured before the first sample of the IMU nobody knows where the vehicle was.
    if (!log.is_within(when) || when < age) continue;
    rosflight::RosflightGnss fix = reader.fix(k);
    fix.rosflight_timestamp = wire_stamp(when - age);
    if (!flight.unix_time) flight.unix_time = reader.unix_time(k);
    if (is_usable(fix) && !reader.has_velocity(k)) {
      ++without_velocity;
      continue;
    }
    if (is_usable(fix) && !is_on_earth(fix)) {
      ++no_numbers;
      continue;
    }
    if (is_usable(fix) && !flight.first_fix) flight.first_fix = fix;
    any_usable = any_usable || is_usable(fix);
    messages.push_back({when, fix});
  }
  log.remark_count(without_velocity, "of its GNSS fixes have no velocity: passed over");
  log.remark_count(no_numbers, "of its GNSS fixes are no numbers: passed over");
  if (fixes.size() == 0) {
    log.remark(
        "it has no GNSS fixes (topic vehicle_gps_position): position and velocity cannot be estimated");
  } else if (!any_usable) {
    log.remark("none of its GNSS fixes is of use: position and velocity cannot be estimated");
  }
  return messages;
}

std::vector<Arrival> read_px4_mag(Px4Log& log, std::optional<int> named, Px4Flight& flight) {
  std::optional<MagneticField> earth;
  if (flight.first_fix) earth = flight.field_there();
  for (const UlogSeries& series : log.file.series()) {
    // A logger announces instances that never come.
    if (series.topic() != "vehicle_magnetometer" || series.size() == 0) continue;
    flight.mags.push_back(
        candidate(series.instance(), log.records("vehicle_magnetometer", series.instance()), earth));
  }
  std::sort(flight.mags.begin(), flight.mags.end(),
            [](const MagCandidate& one, const MagCandidate& other) { return one.instance < other.instance; });
  flight.mag = choose(flight.mags, named, log.name);
  flight.mag_source = mag_source(flight, named.has_value());
  // Before 1.8 the field stood beside the rates.
  const Px4Records mag =
      flight.mag ? log.records("vehicle_magnetometer", *flight.mag) : log.records("sensor_combined");
  const auto field = mag.find("magnetometer_ga");
  if (!field) log.remark("it has no magnetometer: the heading cannot be known, and no filter starts");
  std::vector<Arrival> messages;
  std::size_t no_numbers = 0;
  for (std::size_t k = 0; field && k < mag.size(); ++k) {
    const Time when = mag.measured(k);
    if (!log.is_within(when)) continue;
    const Eigen::Vector3f m = mag.vector(k, field).cast<float>();
    if (!m.allFinite()) {
      ++no_numbers;
      continue;
    }
    messages.push_back({when, rosflight::SmallMag{m.x(), m.y(), m.z()}});
  }
  log.remark_count(no_numbers, "of its samples of the field are no numbers: passed over");
  return messages;
}

std::vector<Arrival> read_px4_baro(Px4Log& log) {
  const Px4Records air = log.first_of({"vehicle_air_data", "sensor_baro", "sensor_combined"});
  const auto temperature = air.find_one_of({"baro_temp_celcius", "ambient_temperature", "temperature"});
  const auto pressure = air.find_one_of({"baro_pressure_pa", "pressure"});
  const auto height = air.find("baro_alt_meter");
  if (!pressure && !height)
    log.remark("it has no barometer: the height cannot be known, and no filter starts");
  std::vector<Arrival> messages;
  std::size_t no_numbers = 0;
  for (std::size_t k = 0; (pressure || height) && k < air.size(); ++k) {
    const Time when = air.measured(k);
    if (!log.is_within(when)) continue;
    double pascal = pressure ? air.number(k, pressure) : autopilot::standard_pressure(air.number(k, height));
    if (!std::isfinite(pascal)) {
      ++no_numbers;
      continue;
    }
    constexpr double kLessThanAnyPascal = 2000.0;  // older versions tell hectopascal
    if (pascal < kLessThanAnyPascal) pascal *= 100.0;
    messages.push_back(
        {when, rosflight::SmallBaro{0.0F, static_cast<float>(pascal),
                                    or_else(air.number(k, temperature) + kZeroCelsius, kUsualTemperature)}});
  }
  log.remark_count(no_numbers, "of its samples of the pressure are no numbers: passed over");
  return messages;
}

}  // namespace ironbird::scenarios
