#include "scenarios/replay/px4_flight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <tuple>

#include "autopilot/math/standard_atmosphere.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/magnetic_field.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Quaternion;
using autopilot::Vector3;
using hil_bridge::Time;
namespace rosflight = hil_bridge::rosflight;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kTeslaPerGauss = 1e-4;
constexpr double kUsualGnssDelay = 0.11;  // s, PX4's own default
constexpr std::int64_t kInvalidSample = 0x7fffffff;
constexpr double kZeroCelsius = 273.15;  // K
constexpr Time kStatusPeriod = std::chrono::milliseconds(100);
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// The fields of one record, by name, of whatever type they are.
class Records {
 public:
  Records() = default;
  Records(const UlogSeries* series, std::int64_t zero) : series_(series), zero_(zero) {
    if (series == nullptr) return;
    timestamp_ = series->find("timestamp");
    sampled_ = series->find("timestamp_sample");
    if (!timestamp_) series_ = nullptr;
  }

  std::size_t size() const { return series_ == nullptr ? 0 : series_->size(); }
  bool has(std::string_view field) const { return series_ != nullptr && series_->find(field).has_value(); }
  std::optional<UlogPlace> find(std::string_view field) const {
    return series_ == nullptr ? std::nullopt : series_->find(field);
  }

  /// When record `k` was published, since the first sample of the IMU.
  Time published(std::size_t k) const { return since_zero(series_->integer(k, *timestamp_)); }
  /// When what it tells was measured, where that is told.
  Time measured(std::size_t k) const {
    const std::int64_t sampled = sampled_ ? series_->integer(k, *sampled_) : 0;
    return sampled > 0 ? since_zero(sampled) : published(k);
  }
  /// NaN for a field that there is not.
  double number(std::size_t k, const std::optional<UlogPlace>& place, std::size_t element = 0) const {
    return place && element < place->count ? series_->number(k, *place, element) : kNoNumber;
  }
  std::int64_t integer(std::size_t k, const std::optional<UlogPlace>& place) const {
    return place ? series_->integer(k, *place) : 0;
  }
  Vector3 vector(std::size_t k, const std::optional<UlogPlace>& place) const {
    return {number(k, place, 0), number(k, place, 1), number(k, place, 2)};
  }

 private:
  Time since_zero(std::int64_t us) const {
    // Stamps are what the file says: the difference of two of them need not fit.
    const auto difference = static_cast<std::uint64_t>(us) - static_cast<std::uint64_t>(zero_);
    constexpr std::int64_t kLongest = 1'000'000'000'000;  // us, eleven days
    const auto passed = std::clamp<std::int64_t>(static_cast<std::int64_t>(difference), -kLongest, kLongest);
    return std::chrono::microseconds(passed);
  }

  const UlogSeries* series_ = nullptr;
  std::int64_t zero_ = 0;
  std::optional<UlogPlace> timestamp_;
  std::optional<UlogPlace> sampled_;
};

std::uint64_t microseconds(Time time) {
  return time > Time::zero() ? static_cast<std::uint64_t>(time.count() / 1000) : 0;
}

/// Takes one log apart.
class Px4Reader {
 public:
  Px4Reader(const UlogFile& file, const std::string& name, const Px4Choice& choice)
      : file_(file), name_(name), choice_(choice) {}

  Px4Flight read() {
    find_zero();
    say_what();
    read_imu();
    read_gnss();
    choose_mag();
    read_mag();
    read_baro();
    read_status();
    read_airborne();
    read_estimate();
    std::stable_sort(messages().begin(), messages().end(), earlier);
    return std::move(out_);
  }

 private:
  std::vector<hil_bridge::Arrival>& messages() { return out_.flight.messages; }
  void remark(std::string text) { out_.flight.remarks.push_back(std::move(text)); }
  Records records(std::string_view topic, int instance = 0) const {
    return {file_.find(topic, instance), zero_};
  }
  /// The first of these topics that was logged.
  Records first_of(std::initializer_list<std::string_view> topics) const {
    for (const std::string_view topic : topics) {
      if (const Records found = records(topic); found.size() > 0) return found;
    }
    return {};
  }
  /// Only what arrived while the IMU was logged: the last values of before are logged with their old stamps.
  bool is_within(Time when) const { return when >= Time::zero() && when <= out_.flight.end; }

  static bool is_imu(const hil_bridge::Arrival& arrival) {
    return std::holds_alternative<rosflight::SmallImu>(arrival.message);
  }
  static bool earlier(const hil_bridge::Arrival& one, const hil_bridge::Arrival& other) {
    return std::tuple(one.when, is_imu(one)) < std::tuple(other.when, is_imu(other));
  }

  void find_zero();
  void say_what();
  /// One sample of the IMU: means over the time before it.
  struct ImuSample {
    Time when{};
    Vector3 force = Vector3::Zero();
    Vector3 rate = Vector3::Zero();
    bool is_finite() const { return force.allFinite() && rate.allFinite(); }
  };
  struct ImuCounts {
    std::size_t backwards = 0;
    std::size_t invalid = 0;
    std::size_t bridged = 0;
  };
  void read_imu();
  void add_imu(const ImuSample& sample);
  /// The logger thins what is logged often. A turn that went on meanwhile must not be lost.
  /// @param length  over which a sample is the mean, ns. @return how many samples were put in between
  std::size_t bridge(const ImuSample& before, const ImuSample& after, double length);
  void read_gnss();
  void choose_mag();
  MagCandidate candidate(int instance, const Records& mag) const;
  void read_mag();
  void read_baro();
  void read_status();
  void read_airborne();
  void read_estimate();

  const UlogFile& file_;
  const std::string& name_;
  const Px4Choice& choice_;
  std::int64_t zero_ = 0;
  std::optional<rosflight::RosflightGnss> first_fix_;
  Px4Flight out_;
};

void Px4Reader::find_zero() {
  const UlogSeries* const imu = file_.find("sensor_combined");
  const auto stamp = imu == nullptr ? std::nullopt : imu->find("timestamp");
  if (!stamp || imu->size() == 0) {
    throw UserError(
        name_ + ": has no IMU samples (topic sensor_combined); set SDLOG_PROFILE so that they are logged");
  }
  zero_ = imu->integer(0, *stamp);
}

std::string version_text(const std::string& number) {
  const std::uint64_t value = std::strtoull(number.c_str(), nullptr, 10);
  const auto part = [value](unsigned shift) { return std::to_string((value >> shift) & 0xFFU); };
  return part(24) + "." + part(16) + "." + part(8) + ((value & 0xFFU) == 0xFFU ? "" : " (development)");
}

void Px4Reader::say_what() {
  const auto& told = file_.information();
  const auto find = [&](const char* key) {
    const auto found = told.find(key);
    return found == told.end() ? std::string() : found->second;
  };
  const std::string version = find("ver_sw_release");
  const std::string board = find("ver_hw");
  out_.flight.what = (find("sys_name").empty() ? "an autopilot" : find("sys_name")) +
                     (version.empty() ? "" : " " + version_text(version)) +
                     (board.empty() ? "" : " on " + board);
  for (std::string& complaint : file_.complaints()) remark(std::move(complaint));
  const Records status = records("vehicle_status");
  const auto hil_state = status.find("hil_state");
  bool simulated = board.find("SITL") != std::string::npos || file_.parameter("SYS_HITL").value_or(0.0) > 0.0;
  for (std::size_t k = 0; k < status.size(); ++k) simulated = simulated || status.integer(k, hil_state) > 0;
  out_.simulated = simulated;
  if (simulated) remark("it is the log of a simulation, not of a flight: its sensors are a model's");
  const auto type = status.find("vehicle_type");
  constexpr std::int64_t kFixedWing = 2;
  for (std::size_t k = 0; k < status.size(); ++k) {
    if (status.integer(k, type) != kFixedWing) continue;
    remark("it is the log of a fixed wing; the estimators take no notice of that, and are not meant for it");
    break;
  }
}

void Px4Reader::read_imu() {
  const Records imu = records("sensor_combined");
  const auto rates = imu.find("gyro_rad");
  const auto forces = imu.find("accelerometer_m_s2");
  const auto relative = imu.find("accelerometer_timestamp_relative");
  const auto length = imu.find("gyro_integral_dt");
  if (!rates || !forces) throw UserError(name_ + ": its IMU samples have no rates or no specific forces");
  std::optional<ImuSample> before;
  ImuCounts counts;
  for (std::size_t k = 0; k < imu.size(); ++k) {
    ImuSample sample{imu.published(k), imu.vector(k, forces), imu.vector(k, rates)};
    if ((before && sample.when <= before->when) || sample.when < Time::zero()) {
      ++counts.backwards;
      continue;
    }
    if (imu.integer(k, relative) == kInvalidSample) sample.force.setConstant(kNoNumber);
    if (!sample.is_finite()) ++counts.invalid;
    // Before 1.7 in seconds.
    const double us = imu.number(k, length) * (length && length->type == UlogType::kFloat ? 1e6 : 1.0);
    if (before && us > 0.0) counts.bridged += bridge(*before, sample, 1e3 * us);
    add_imu(sample);
    before = sample;
  }
  out_.flight.end = before ? before->when : Time::zero();
  const auto tell = [this](std::size_t count, const char* what) {
    if (count > 0) remark(std::to_string(count) + " samples of the IMU " + what);
  };
  tell(counts.backwards, "whose time does not go on passed over");
  tell(counts.invalid, "are not valid: the estimators do without them");
  tell(counts.bridged, "that the log lacks taken from their neighbours");
}

void Px4Reader::add_imu(const ImuSample& sample) {
  const Eigen::Vector3f f = sample.force.cast<float>();
  const Eigen::Vector3f w = sample.rate.cast<float>();
  messages().push_back({sample.when, rosflight::SmallImu{microseconds(sample.when), f.x(), f.y(), f.z(),
                                                         w.x(), w.y(), w.z(), 0.0F}});
}

std::size_t Px4Reader::bridge(const ImuSample& before, const ImuSample& after, double length) {
  constexpr double kMost = 5.0;  // samples: a longer gap is a gap
  const double gap = static_cast<double>((after.when - before.when).count()) - length;
  const double missing = std::round(gap / length);
  if (!(missing >= 1.0 && missing <= kMost) || !before.is_finite() || !after.is_finite()) return 0;
  for (double k = 1.0; k <= missing; ++k) {
    const double share = k / (missing + 1.0);
    add_imu({before.when + Time(std::llround(gap * k / missing)),
             before.force + share * (after.force - before.force),
             before.rate + share * (after.rate - before.rate)});
  }
  return static_cast<std::size_t>(missing);
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

void Px4Reader::read_gnss() {
  const Records gnss = first_of({"vehicle_gps_position", "sensor_gps"});
  out_.gnss_delay =
      choice_.gnss_delay.value_or(1e-3 * file_.parameter("EKF2_GPS_DELAY").value_or(1e3 * kUsualGnssDelay));
  const Time delay(std::llround(out_.gnss_delay * 1e9));
  const bool in_degrees = gnss.has("latitude_deg");
  const auto latitude = gnss.find(in_degrees ? "latitude_deg" : "lat");
  const auto longitude = gnss.find(in_degrees ? "longitude_deg" : "lon");
  const auto altitude = gnss.find(in_degrees ? "altitude_msl_m" : "alt");
  const double angle_unit = in_degrees ? 1.0 : 1e-7;
  const double height_unit = in_degrees ? 1.0 : 1e-3;
  const auto fix = gnss.find("fix_type");
  const auto velocity_valid = gnss.find("vel_ned_valid");
  const auto utc = gnss.find("time_utc_usec");
  const auto float_at = [&](std::size_t k, const char* field) {
    return static_cast<float>(gnss.number(k, gnss.find(field)));
  };
  int usable = 0;
  for (std::size_t k = 0; k < gnss.size(); ++k) {
    const Time when = gnss.published(k);
    if (!is_within(when)) continue;
    rosflight::RosflightGnss message;
    message.lat = angle_unit * gnss.number(k, latitude);
    message.lon = angle_unit * gnss.number(k, longitude);
    message.height = static_cast<float>(height_unit * gnss.number(k, altitude));
    message.rosflight_timestamp = microseconds(when - delay);
    message.vel_n = float_at(k, "vel_n_m_s");
    message.vel_e = float_at(k, "vel_e_m_s");
    message.vel_d = float_at(k, "vel_d_m_s");
    message.h_acc = float_at(k, "eph");
    message.v_acc = float_at(k, "epv");
    message.s_acc = float_at(k, "s_variance_m_s");
    message.num_sat = static_cast<std::uint8_t>(
        std::clamp<std::int64_t>(gnss.integer(k, gnss.find("satellites_used")), 0, 255));
    const bool moving_known = !velocity_valid || gnss.integer(k, velocity_valid) != 0;
    message.fix_type = moving_known ? fix_type(gnss.integer(k, fix)) : 0;
    const std::int64_t us = gnss.integer(k, utc);
    constexpr std::int64_t kEarliest = 946'684'800'000'000;  // us, the year 2000
    constexpr std::int64_t kLatest = 4'102'444'800'000'000;  // 2100
    if (!out_.unix_time && us > kEarliest && us < kLatest) out_.unix_time = 1e-6 * static_cast<double>(us);
    if (autopilot::is_usable(static_cast<autopilot::GnssFix>(message.fix_type))) {
      ++usable;
      if (!first_fix_) first_fix_ = message;
    }
    messages().push_back({when, message});
  }
  if (gnss.size() == 0) {
    remark("it has no GNSS fixes (topic vehicle_gps_position): position and velocity cannot be estimated");
  } else if (usable == 0) {
    remark("none of its GNSS fixes is one in three dimensions: position and velocity cannot be estimated");
  }
}

/// Samples of one magnetometer, tesla.
std::vector<Vector3> field_of(const Records& mag) {
  std::vector<Vector3> samples;
  const auto field = mag.find("magnetometer_ga");
  for (std::size_t k = 0; field && k < mag.size(); ++k) {
    const Vector3 m_B = kTeslaPerGauss * mag.vector(k, field);
    if (m_B.allFinite() && m_B.norm() > 0.0) samples.push_back(m_B);
  }
  return samples;
}

// How far the strength is from the earth's, and how it spreads: both come from iron and currents nearby.
MagCandidate Px4Reader::candidate(int instance, const Records& mag) const {
  MagCandidate found{.instance = instance};
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
  double offset = 0.0;
  if (first_fix_) {
    const MagneticField earth =
        magnetic_field(first_fix_->lat * kRadiansPerDegree, first_fix_->lon * kRadiansPerDegree,
                       static_cast<double>(first_fix_->height), decimal_year(out_.unix_time.value_or(0.0)));
    offset = found.strength / earth.strength - 1.0;
  }
  found.misfit = std::hypot(offset, found.spread);
  return found;
}

void Px4Reader::choose_mag() {
  for (const UlogSeries& series : file_.series()) {
    if (series.topic() != "vehicle_magnetometer") continue;
    out_.mags.push_back(candidate(series.instance(), records("vehicle_magnetometer", series.instance())));
  }
  std::sort(out_.mags.begin(), out_.mags.end(),
            [](const MagCandidate& one, const MagCandidate& other) { return one.instance < other.instance; });
  if (choice_.mag) {
    const auto named = std::find_if(out_.mags.begin(), out_.mags.end(),
                                    [&](const MagCandidate& mag) { return mag.instance == *choice_.mag; });
    if (named == out_.mags.end()) {
      std::string there;
      for (const MagCandidate& mag : out_.mags)
        there += (there.empty() ? "" : ", ") + std::to_string(mag.instance);
      throw UserError(name_ + ": has no magnetometer " + std::to_string(*choice_.mag) +
                      (there.empty() ? "; it has none" : "; there are: " + there));
    }
    out_.mag = *choice_.mag;
    return;
  }
  const auto best = std::min_element(
      out_.mags.begin(), out_.mags.end(),
      [](const MagCandidate& one, const MagCandidate& other) { return one.misfit < other.misfit; });
  if (best != out_.mags.end() && best->samples > 0) out_.mag = best->instance;
}

void Px4Reader::read_mag() {
  // Before 1.8 the field stood beside the rates.
  const Records mag = out_.mag >= 0 ? records("vehicle_magnetometer", out_.mag) : records("sensor_combined");
  const auto field = mag.find("magnetometer_ga");
  if (!field) remark("it has no magnetometer: the heading cannot be known, and no filter starts");
  for (std::size_t k = 0; field && k < mag.size(); ++k) {
    const Time when = mag.published(k);
    if (!is_within(when)) continue;
    const Eigen::Vector3f m = mag.vector(k, field).cast<float>();
    messages().push_back({when, rosflight::SmallMag{m.x(), m.y(), m.z()}});
  }
}

void Px4Reader::read_baro() {
  const Records air = first_of({"vehicle_air_data", "sensor_baro", "sensor_combined"});
  const bool has_temperature = air.has("baro_temp_celcius");
  const auto temperature = air.find(has_temperature                  ? "baro_temp_celcius"
                                    : air.has("ambient_temperature") ? "ambient_temperature"
                                                                     : "temperature");
  const auto pressure = air.find(air.has("baro_pressure_pa") ? "baro_pressure_pa" : "pressure");
  const auto height = air.find("baro_alt_meter");
  if (!pressure && !height) remark("it has no barometer: the height cannot be known, and no filter starts");
  for (std::size_t k = 0; (pressure || height) && k < air.size(); ++k) {
    const Time when = air.published(k);
    if (!is_within(when)) continue;
    double pascal = pressure ? air.number(k, pressure) : autopilot::standard_pressure(air.number(k, height));
    constexpr double kLessThanAnyPascal = 2000.0;  // older versions tell hectopascal
    if (pascal < kLessThanAnyPascal) pascal *= 100.0;
    messages().push_back(
        {when, rosflight::SmallBaro{0.0F, static_cast<float>(pascal),
                                    static_cast<float>(air.number(k, temperature) + kZeroCelsius)}});
  }
}

// With samples of the IMU only: two of them may be days apart.
void Px4Reader::read_status() {
  const Records status = records("vehicle_status");
  const auto arming = status.find("arming_state");
  constexpr std::int64_t kArmed = 2;
  std::size_t next = 0;
  bool armed = false;
  Time due{};
  const std::size_t so_far = messages().size();
  for (std::size_t k = 0; k < so_far; ++k) {
    const Time now = messages()[k].when;
    if (!is_imu(messages()[k]) || now < due) continue;
    for (; next < status.size() && status.published(next) <= now; ++next) {
      armed = status.integer(next, arming) == kArmed;
    }
    messages().push_back(
        {now, rosflight::RosflightStatus{.armed = static_cast<std::uint8_t>(armed ? 1 : 0)}});
    due = now + kStatusPeriod;
  }
}

void Px4Reader::read_airborne() {
  const Records detected = records("vehicle_land_detected");
  const auto landed = detected.find("landed");
  std::optional<Time> since;
  for (std::size_t k = 0; landed && k < detected.size(); ++k) {
    const bool in_air = detected.integer(k, landed) == 0;
    const Time when = std::clamp(detected.published(k), Time::zero(), out_.flight.end);
    if (in_air && !since) since = when;
    if (!in_air && since) {
      out_.flight.airborne.push_back({*since, when});
      since.reset();
    }
  }
  if (since) out_.flight.airborne.push_back({*since, out_.flight.end});
}

void Px4Reader::read_estimate() {
  RecordedEstimate px4;
  px4.name = "PX4";
  const Records attitude = records("vehicle_attitude");
  const auto q = attitude.find("q");
  for (std::size_t k = 0; q && k < attitude.size(); ++k) {
    const Quaternion q_NB(attitude.number(k, q, 0), attitude.number(k, q, 1), attitude.number(k, q, 2),
                          attitude.number(k, q, 3));
    const bool is_one = std::abs(q_NB.norm() - 1.0) < 0.1;
    if (is_one && is_within(attitude.measured(k)))
      px4.attitudes.push_back({attitude.measured(k), q_NB.normalized()});
  }
  const Records local = records("vehicle_local_position");
  const auto field = [&](const char* name) { return local.find(name); };
  const auto valid = [&](std::size_t k, const char* name) {
    return !field(name) || local.integer(k, field(name)) != 0;
  };
  for (std::size_t k = 0; k < local.size(); ++k) {
    RecordedPosition position{.stamp = local.measured(k)};
    if (!is_within(position.stamp)) continue;
    position.p_NB_N << local.number(k, field("x")), local.number(k, field("y")), local.number(k, field("z"));
    position.v_NB_N << local.number(k, field("vx")), local.number(k, field("vy")),
        local.number(k, field("vz"));
    position.position_known = valid(k, "xy_valid") && position.p_NB_N.head<2>().allFinite();
    position.height_known = valid(k, "z_valid") && std::isfinite(position.p_NB_N.z());
    position.velocity_known = valid(k, "v_xy_valid") && valid(k, "v_z_valid") && position.v_NB_N.allFinite();
    const double latitude = local.number(k, field("ref_lat"));
    const double longitude = local.number(k, field("ref_lon"));
    if (!px4.origin.known && position.position_known && std::isfinite(latitude) && std::isfinite(longitude)) {
      px4.origin = {true, latitude * kRadiansPerDegree, longitude * kRadiansPerDegree,
                    local.number(k, field("ref_alt"))};
    }
    px4.positions.push_back(position);
  }
  const auto by_stamp = [](const auto& one, const auto& other) { return one.stamp < other.stamp; };
  std::stable_sort(px4.attitudes.begin(), px4.attitudes.end(), by_stamp);
  std::stable_sort(px4.positions.begin(), px4.positions.end(), by_stamp);
  if (px4.attitudes.empty() && px4.positions.empty()) {
    remark("it has no estimate of PX4's to compare with");
    return;
  }
  out_.flight.estimates.push_back(std::move(px4));
}

}  // namespace

Px4Flight read_px4_flight(const UlogFile& file, const std::string& name, const Px4Choice& choice) {
  return Px4Reader(file, name, choice).read();
}

}  // namespace ironbird::scenarios
