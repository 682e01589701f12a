#include "scenarios/replay/csv_flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "autopilot/math/euler_zyx.hpp"
#include "autopilot/math/local_map.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/degrees.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/arrivals.hpp"
#include "scenarios/replay/direction_axes.hpp"
#include "scenarios/replay/made_sensors.hpp"
#include "scenarios/replay/mapped_table.hpp"
#include "scenarios/replay/truth_track.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Matrix3;
using autopilot::Quaternion;
using autopilot::Vector3;
using hil_bridge::Arrival;
using hil_bridge::Time;
namespace rosflight = hil_bridge::rosflight;

constexpr double kLongestFlight = 864'000.0;  // s

class CsvFlightReader {
 public:
  CsvFlightReader(const LoadedColumnMap& loaded, const std::filesystem::path& data)
      : loaded_(loaded), map_(loaded.map), data_(data) {}

  CsvFlight read() {
    csv_.flight.what = map_.what.empty() ? loaded_.file.stem().string() : map_.what;
    check_made();
    read_imu();
    if (map_.magnetometer) read_magnetometer(*map_.magnetometer);
    if (map_.barometer) read_barometer(*map_.barometer);
    if (map_.gnss) read_gnss(*map_.gnss);
    if (map_.truth) read_truth(*map_.truth);
    find_field();
    make_missing();
    remark_missing();
    // Of those at one time the IMU's is the last.
    std::stable_sort(messages().begin(), messages().end(), [](const Arrival& one, const Arrival& other) {
      return std::tuple(one.when, is_imu(one)) < std::tuple(other.when, is_imu(other));
    });
    csv_.flight.airborne = {{Time::zero(), csv_.flight.end}};
    return std::move(csv_);
  }

 private:
  std::vector<Arrival>& messages() { return csv_.flight.messages; }
  void remark(std::string text) { csv_.flight.remarks.push_back(std::move(text)); }
  MappedTable table(const std::string& path, const TableLayout& layout, const TimeColumn& time) const {
    return {loaded_, path, layout, time, data_};
  }
  Time since_zero(double time) const { return from_seconds(time - zero_); }
  bool is_within(Time when) const { return when >= Time::zero() && when <= csv_.flight.end; }

  Matrix3 body(const std::string& path, const std::string& axes) const {
    if (axes.empty()) return Matrix3::Identity();
    try {
      return body_from_axes(axes);
    } catch (const AxesError& error) {
      throw loaded_.error(path, error.what());
    }
  }
  Matrix3 north(const std::string& path, const std::string& axes) const {
    if (axes.empty()) return Matrix3::Identity();
    try {
      return north_from_axes(axes);
    } catch (const AxesError& error) {
      throw loaded_.error(path, error.what());
    }
  }

  void check_made() const {
    const auto refuse_two = [&](bool recorded, bool made, const std::string& name) {
      if (recorded && made)
        throw loaded_.error("made." + name, "there is a recorded one: leave out one of them");
    };
    refuse_two(map_.gnss.has_value(), map_.made.gnss.has_value(), "gnss");
    refuse_two(map_.barometer.has_value(), map_.made.barometer.has_value(), "barometer");
    refuse_two(map_.magnetometer.has_value(), map_.made.magnetometer.has_value(), "magnetometer");
    const bool has_position = map_.truth && map_.truth->position;
    const bool has_attitude = map_.truth && map_.truth->attitude;
    if (map_.made.gnss && !has_position)
      throw loaded_.error("made.gnss", "is made from truth.position: there is none");
    if (map_.made.gnss && !map_.made.gnss->p_BA_B.isZero())
      throw loaded_.error("made.gnss.p_BA_B", "must be 0: the antenna is where truth.position is");
    if (map_.made.barometer && !has_position)
      throw loaded_.error("made.barometer", "is made from truth.position: there is none");
    if (map_.made.magnetometer && !has_attitude)
      throw loaded_.error("made.magnetometer", "is made from truth.attitude: there is none");
    if ((map_.made.gnss || map_.made.barometer || map_.made.magnetometer) && !map_.place)
      throw loaded_.error("place", "is missing: sensors are made for a place, its pressure and its field");
  }

  void read_imu() {
    if (!map_.imu) throw loaded_.error("imu", "is missing: without an IMU there is nothing to replay");
    const ImuColumns& imu = *map_.imu;
    if (imu.accelerometer.columns.empty())
      throw loaded_.error("imu.accelerometer.columns", "is missing: an estimator needs specific forces");
    if (imu.gyro.columns.empty())
      throw loaded_.error("imu.gyro.columns", "is missing: an estimator needs angular rates");
    MappedTable samples = table("imu", imu, imu.time);
    const std::size_t rate = samples.want("gyro", imu.gyro, "rad/s");
    const std::size_t force = samples.want("accelerometer", imu.accelerometer, "m/s^2");
    const Matrix3 R_BG = body("imu.gyro.axes", imu.gyro.axes);
    const Matrix3 R_BA = body("imu.accelerometer.axes", imu.accelerometer.axes);
    samples.read(csv_.flight.remarks);
    if (samples.size() == 0) throw UserError(samples.name() + ": has no IMU samples");
    zero_ = samples.time(0);
    std::size_t count = samples.size();
    while (samples.time(count - 1) - zero_ > kLongestFlight) --count;
    if (count < samples.size())
      remark("imu: " + std::to_string(samples.size() - count) +
             " rows more than ten days after the first left out");
    Time due{};
    for (std::size_t row = 0; row < count; ++row) {
      const Time when = since_zero(samples.time(row));
      const Eigen::Vector3f f = (R_BA * samples.vector(row, force)).cast<float>();
      const Eigen::Vector3f w = (R_BG * samples.vector(row, rate)).cast<float>();
      if (when >= due) {
        messages().push_back({when, rosflight::RosflightStatus{.armed = 1}});
        due = when + kStatusPeriod;
      }
      messages().push_back(
          {when, rosflight::SmallImu{wire_stamp(when), f.x(), f.y(), f.z(), w.x(), w.y(), w.z(), 0.0F}});
      csv_.flight.end = when;
    }
  }

  void read_magnetometer(const MagnetometerColumns& columns) {
    MappedTable samples = table("magnetometer", columns, columns.time);
    const std::size_t field = samples.want("field", columns.field, "T");
    const Matrix3 R_BM = body("magnetometer.field.axes", columns.field.axes);
    samples.read(csv_.flight.remarks);
    for (std::size_t row = 0; row < samples.size(); ++row) {
      const Time when = since_zero(samples.time(row));
      const Eigen::Vector3f m = (R_BM * samples.vector(row, field)).cast<float>();
      if (is_within(when)) messages().push_back({when, rosflight::SmallMag{m.x(), m.y(), m.z()}});
    }
  }

  void read_barometer(const BarometerColumns& columns) {
    constexpr float kUsualTemperature = 288.15F;  // K
    MappedTable samples = table("barometer", columns, columns.time);
    const std::size_t pressure = samples.want("pressure", columns.pressure, "Pa");
    samples.read(csv_.flight.remarks);
    for (std::size_t row = 0; row < samples.size(); ++row) {
      const Time when = since_zero(samples.time(row));
      const auto pascal = static_cast<float>(samples.number(row, pressure));
      if (is_within(when))
        messages().push_back({when, rosflight::SmallBaro{0.0F, pascal, kUsualTemperature}});
    }
  }

  /// Wants latitude, longitude and altitude. @return the number of the first
  static std::size_t want_place(MappedTable& samples, const std::string& path, const GeodeticColumns& place) {
    const std::size_t first = samples.want(path + ".latitude", place.latitude, "rad");
    samples.want(path + ".longitude", place.longitude, "rad");
    samples.want(path + ".altitude", place.altitude, "m");
    return first;
  }

  void read_gnss(const GnssColumns& columns) {
    MappedTable samples = table("gnss", columns, columns.time);
    if (columns.velocity.columns.empty())
      throw loaded_.error("gnss.velocity", "is missing: the estimators take fixes with a velocity only");
    const std::size_t place = want_place(samples, "place", columns.place);
    const std::size_t velocity = samples.want("velocity", columns.velocity, "m/s");
    const Matrix3 R_NV = north("gnss.velocity.axes", columns.velocity.axes);
    samples.read(csv_.flight.remarks);
    csv_.gnss_delay = columns.delay;
    std::size_t nowhere = 0;
    for (std::size_t row = 0; row < samples.size(); ++row) {
      const Time measured = since_zero(samples.time(row));
      const Time when = measured + from_seconds(columns.delay);
      if (!is_within(measured) || !is_within(when)) continue;
      const Vector3 where = samples.vector(row, place);
      if (std::abs(where.x()) > 0.5 * std::numbers::pi || std::abs(where.y()) > std::numbers::pi) {
        ++nowhere;
        continue;
      }
      messages().push_back({when, fix_of(columns, measured, where, R_NV * samples.vector(row, velocity))});
      if (!first_fix_) first_fix_ = where;
    }
    if (nowhere > 0) remark("gnss: " + std::to_string(nowhere) + " fixes lie nowhere on earth: passed over");
  }

  static rosflight::RosflightGnss fix_of(const GnssColumns& columns, Time measured, const Vector3& where,
                                         const Vector3& v_NB_N) {
    rosflight::RosflightGnss fix;
    fix.rosflight_timestamp = wire_stamp(measured);
    fix.lat = where.x() * kDegreesPerRadian;
    fix.lon = where.y() * kDegreesPerRadian;
    fix.height = static_cast<float>(where.z());
    fix.vel_n = static_cast<float>(v_NB_N.x());
    fix.vel_e = static_cast<float>(v_NB_N.y());
    fix.vel_d = static_cast<float>(v_NB_N.z());
    fix.h_acc = static_cast<float>(columns.horizontal_accuracy);
    fix.v_acc = static_cast<float>(columns.vertical_accuracy);
    fix.s_acc = static_cast<float>(columns.speed_accuracy);
    fix.fix_type = static_cast<std::uint8_t>(autopilot::GnssFix::kFix3D);
    return fix;
  }

  void refuse_levers(const PositionColumns& columns, bool has_attitude) const {
    const std::string path = "truth.position.p_BA_B";
    if (columns.p_BA_B.isZero()) return;
    if (!has_attitude) throw loaded_.error(path, "needs truth.attitude");
    if (columns.velocity) throw loaded_.error(path, "cannot be together with `velocity`: leave that out");
  }

  void read_truth(const TruthColumns& columns) {
    RecordedEstimate truth;
    truth.name = columns.name;
    if (map_.place) truth.origin = {true, map_.place->latitude, map_.place->longitude, map_.place->altitude};
    if (columns.position) {
      refuse_levers(*columns.position, columns.attitude.has_value());
      read_positions(*columns.position, truth);
    }
    if (columns.attitude) read_attitudes(*columns.attitude, truth);
    if (columns.position) complete(*columns.position, truth);
    csv_.flight.estimates.push_back(std::move(truth));
  }

  void read_positions(const PositionColumns& columns, RecordedEstimate& truth) {
    const std::string path = "truth.position";
    MappedTable samples = table(path, columns, columns.time);
    if (columns.local.has_value() == columns.place.has_value())
      throw loaded_.error(path, "must have either `local` or `place`");
    const std::size_t first = columns.local ? samples.want("local", *columns.local, "m")
                                            : want_place(samples, "place", *columns.place);
    const Matrix3 R_NP =
        columns.local ? north(path + ".local.axes", columns.local->axes) : Matrix3::Identity();
    std::size_t velocity = 0;
    Matrix3 R_NV = Matrix3::Identity();
    if (columns.velocity) {
      velocity = samples.want("velocity", *columns.velocity, "m/s");
      R_NV = north(path + ".velocity.axes", columns.velocity->axes);
    }
    samples.read(csv_.flight.remarks);
    for (std::size_t row = 0; row < samples.size(); ++row) {
      const Vector3 at = samples.vector(row, first);
      if (columns.place && !truth.origin.known) truth.origin = {true, at.x(), at.y(), at.z()};
      RecordedPosition position;
      position.stamp = since_zero(samples.time(row));
      position.p_NB_N = columns.local
                            ? Vector3(R_NP * at)
                            : autopilot::local_from_geodetic({at.x(), at.y(), at.z()}, truth.origin);
      position.velocity_known = columns.velocity.has_value();
      if (columns.velocity) position.v_NB_N = R_NV * samples.vector(row, velocity);
      truth.positions.push_back(position);
    }
  }

  /// What follows from position and attitude together.
  void complete(const PositionColumns& columns, RecordedEstimate& truth) {
    if (!columns.p_BA_B.isZero()) {
      const std::size_t taken_out = move_to_body(truth, columns.p_BA_B);
      if (taken_out > 0)
        remark("truth.position: " + std::to_string(taken_out) +
               " positions left out at whose time the attitude is not known");
    }
    if (columns.velocity) return;
    add_slopes(truth.positions, columns.velocity_over);
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "'s velocity is the slope of its positions over %.2g s",
                  columns.velocity_over);
    remark(truth.name + text.data());
  }

  void read_attitudes(const AttitudeColumns& columns, RecordedEstimate& truth) {
    const std::string path = "truth.attitude";
    MappedTable samples = table(path, columns, columns.time);
    const bool is_euler = !columns.euler.empty();
    if (is_euler == !columns.quaternion.empty())
      throw loaded_.error(path, "must have either `euler` or `quaternion`");
    const std::size_t first = is_euler ? samples.want("euler", columns.euler, 3, columns.unit, "rad")
                                       : samples.want("quaternion", columns.quaternion, 4, "", "1");
    const Quaternion q_NW(north(path + ".world", columns.world));
    const Quaternion q_BA(body(path + ".body", columns.body));
    samples.read(csv_.flight.remarks);
    std::size_t odd = 0;
    for (std::size_t row = 0; row < samples.size(); ++row) {
      const Quaternion q_WA =
          is_euler ? autopilot::quaternion_NB(samples.vector(row, first))
                   : Quaternion(samples.number(row, first), samples.number(row, first + 1),
                                samples.number(row, first + 2), samples.number(row, first + 3));
      constexpr double kOff = 0.1;
      if (std::abs(q_WA.norm() - 1.0) > kOff) {
        ++odd;
        continue;
      }
      truth.attitudes.push_back(
          {since_zero(samples.time(row)), (q_NW * q_WA.normalized() * q_BA.conjugate()).normalized()});
    }
    if (odd > 0) remark(path + ": " + std::to_string(odd) + " quaternions are no rotations: left out");
  }

  void find_field() {
    std::optional<Vector3> where = first_fix_;
    if (map_.place) where = Vector3(map_.place->latitude, map_.place->longitude, map_.place->altitude);
    if (!where) return;
    csv_.dated = map_.place && map_.place->year;
    const double year = csv_.dated ? *map_.place->year : newest_epoch();
    csv_.field = magnetic_field(where->x(), where->y(), where->z(), year);
  }

  void make_missing() {
    const MadeSensors& made = map_.made;
    if (!made.gnss && !made.barometer && !made.magnetometer) return;
    simulator::SensorSite site;
    site.latitude = map_.place->latitude;
    site.longitude = map_.place->longitude;
    site.altitude = map_.place->altitude;
    site.magnetic_field_N = csv_.field->b_N;
    const RecordedEstimate& truth = csv_.flight.estimates.front();
    MadeMessages done = make_sensors(made, truth, site, csv_.flight.end);
    messages().insert(messages().end(), done.messages.begin(), done.messages.end());
    for (std::string& line : done.remarks) remark(std::move(line));
    std::string names;
    for (const std::string& name : done.names) names += (names.empty() ? "" : ", ") + name;
    if (!names.empty()) csv_.flight.what += " (" + names + " made from " + truth.name + ")";
    if (made.gnss) csv_.gnss_delay = made.gnss->timing.latency;
  }

  template <class Message>
  bool has() {
    return std::any_of(messages().begin(), messages().end(), [](const Arrival& arrival) {
      return std::holds_alternative<Message>(arrival.message);
    });
  }

  void remark_missing() {
    if (!has<rosflight::RosflightGnss>())
      remark("it has no GNSS fixes: position and velocity cannot be estimated");
    if (!has<rosflight::SmallMag>())
      remark("it has no magnetometer: the heading cannot be known, and no filter starts");
    if (!has<rosflight::SmallBaro>())
      remark("it has no barometer: the height cannot be known, and no filter starts");
    if (csv_.flight.estimates.empty()) remark("it has no truth to compare with");
  }

  const LoadedColumnMap& loaded_;
  const ColumnMap& map_;
  std::filesystem::path data_;
  CsvFlight csv_;
  double zero_ = 0.0;                 // s, of the first sample of the IMU
  std::optional<Vector3> first_fix_;  // latitude, longitude, altitude
};

}  // namespace

CsvFlight read_csv_flight(const LoadedColumnMap& loaded, const std::filesystem::path& data) {
  return CsvFlightReader(loaded, data).read();
}

}  // namespace ironbird::scenarios
