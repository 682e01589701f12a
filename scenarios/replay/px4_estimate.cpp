#include "scenarios/replay/px4_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/math/local_map.hpp"
#include "scenarios/bench/run_time.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::LocalOrigin;
using autopilot::Quaternion;
using autopilot::Vector3;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

std::vector<RecordedAttitude> attitudes_of(Px4Log& log) {
  std::vector<RecordedAttitude> attitudes;
  const Px4Records attitude = log.records("vehicle_attitude");
  const auto q = attitude.find("q");
  std::size_t no_rotations = 0;
  for (std::size_t k = 0; q && k < attitude.size(); ++k) {
    const Quaternion q_NB(attitude.number(k, q, 0), attitude.number(k, q, 1), attitude.number(k, q, 2),
                          attitude.number(k, q, 3));
    const bool is_rotation = std::abs(q_NB.norm() - 1.0) < 0.1;
    if (!log.is_within(attitude.measured(k))) continue;
    if (is_rotation) attitudes.push_back({attitude.measured(k), q_NB.normalized()});
    no_rotations += is_rotation ? 0 : 1;
  }
  log.remark_count(no_rotations, "of PX4's attitudes are none: passed over");
  return attitudes;
}

/// Reads vehicle_local_position.
class PositionReader {
 public:
  explicit PositionReader(const Px4Records& local)
      : local_(local),
        x_(local.find("x")),
        y_(local.find("y")),
        z_(local.find("z")),
        vx_(local.find("vx")),
        vy_(local.find("vy")),
        vz_(local.find("vz")),
        xy_valid_(local.find("xy_valid")),
        z_valid_(local.find("z_valid")),
        v_xy_valid_(local.find("v_xy_valid")),
        v_z_valid_(local.find("v_z_valid")),
        xy_global_(local.find("xy_global")),
        latitude_(local.find("ref_lat")),
        longitude_(local.find("ref_lon")),
        altitude_(local.find("ref_alt")) {}

  RecordedPosition position(std::size_t k) const {
    RecordedPosition position;
    position.stamp = local_.measured(k);
    position.p_NB_N << local_.number(k, x_), local_.number(k, y_), local_.number(k, z_);
    position.v_NB_N << local_.number(k, vx_), local_.number(k, vy_), local_.number(k, vz_);
    position.position_known = holds(k, xy_valid_) && position.p_NB_N.head<2>().allFinite();
    position.height_known = holds(k, z_valid_) && std::isfinite(position.p_NB_N.z());
    position.velocity_known = holds(k, v_xy_valid_) && holds(k, v_z_valid_) && position.v_NB_N.allFinite();
    return position;
  }
  /// Where N begins for record `k`, where that is known.
  LocalOrigin origin(std::size_t k) const {
    LocalOrigin origin;
    origin.latitude = local_.number(k, latitude_) * kRadiansPerDegree;
    origin.longitude = local_.number(k, longitude_) * kRadiansPerDegree;
    const double altitude = local_.number(k, altitude_);
    origin.altitude = std::isfinite(altitude) ? altitude : 0.0;
    origin.known = holds(k, xy_global_) && std::abs(origin.latitude) <= 0.5 * std::numbers::pi &&
                   std::abs(origin.longitude) <= std::numbers::pi &&
                   (origin.latitude != 0.0 || origin.longitude != 0.0);
    return origin;
  }

 private:
  /// What a version does not tell holds.
  bool holds(std::size_t k, const std::optional<UlogPlace>& place) const {
    return !place || local_.integer(k, place) != 0;
  }

  const Px4Records& local_;
  std::optional<UlogPlace> x_, y_, z_, vx_, vy_, vz_, xy_valid_, z_valid_, v_xy_valid_, v_z_valid_,
      xy_global_, latitude_, longitude_, altitude_;
};

std::string in_tenths(double value) {
  std::array<char, 32> text{};
  const double rounded = std::round(value * 10.0) / 10.0;
  std::snprintf(text.data(), text.size(), "%.1f", rounded == 0.0 ? 0.0 : rounded);
  return text.data();
}

/// The records at which a counter of PX4's resets moved while the IMU was logged.
std::vector<std::size_t> steps_of(const Px4Log& log, const Px4Records& records, const char* counter) {
  const auto place = records.find(counter);
  std::optional<std::int64_t> last;
  std::vector<std::size_t> steps;
  for (std::size_t k = 0; place && k < records.size(); ++k) {
    if (!log.is_within(records.published(k))) continue;
    const std::int64_t value = records.integer(k, place);
    if (last && value != *last) steps.push_back(k);
    last = value;
  }
  return steps;
}

/// When PX4 set its heading anew and by how much: there the difference to it may jump, and not by our doing.
void remark_heading_steps(Px4Log& log, const Px4Records& local) {
  constexpr std::size_t kListed = 5;
  const std::vector<std::size_t> steps = steps_of(log, local, "heading_reset_counter");
  if (steps.empty()) return;
  const auto change = local.find("delta_heading");
  std::string text = "PX4 stepped its heading";
  for (std::size_t i = 0; i < std::min(steps.size(), kListed); ++i) {
    const double when = to_seconds(local.published(steps[i]));
    const double by = local.number(steps[i], change) / kRadiansPerDegree;
    text += i == 0 ? " " : ", ";
    if (std::abs(by) <= 360.0) text += "by " + in_tenths(by) + " deg ";
    text += "at " + in_tenths(when) + " s";
  }
  if (steps.size() > kListed) text += " and " + std::to_string(steps.size() - kListed) + " times more";
  log.remark(std::move(text));
}

void add_positions(Px4Log& log, RecordedEstimate& px4) {
  const Px4Records local = log.records("vehicle_local_position");
  const PositionReader reader(local);
  std::size_t moved = 0;
  LocalOrigin last;
  for (std::size_t k = 0; k < local.size(); ++k) {
    RecordedPosition position = reader.position(k);
    if (!log.is_within(position.stamp)) continue;
    const LocalOrigin origin = reader.origin(k);
    if (!px4.origin.known && origin.known && position.position_known) px4.origin = last = origin;
    if (origin.known && px4.origin.known) {
      const bool same = origin.latitude == last.latitude && origin.longitude == last.longitude &&
                        origin.altitude == last.altitude;
      if (!same) ++moved;
      last = origin;
      position.p_NB_N =
          autopilot::local_from_geodetic(autopilot::geodetic_from_local(position.p_NB_N, origin), px4.origin);
    }
    px4.positions.push_back(position);
  }
  log.remark_count(moved, "times PX4 moved the origin of its positions: they are compared on the earth");
  log.remark_count(steps_of(log, local, "xy_reset_counter").size(), "times PX4 stepped its position");
  remark_heading_steps(log, local);
}

}  // namespace

std::optional<RecordedEstimate> read_px4_estimate(Px4Log& log) {
  RecordedEstimate px4;
  px4.name = "PX4";
  px4.attitudes = attitudes_of(log);
  add_positions(log, px4);
  const auto by_stamp = [](const auto& one, const auto& other) { return one.stamp < other.stamp; };
  std::stable_sort(px4.attitudes.begin(), px4.attitudes.end(), by_stamp);
  std::stable_sort(px4.positions.begin(), px4.positions.end(), by_stamp);
  if (!px4.attitudes.empty() || !px4.positions.empty()) return px4;
  log.remark("it has no estimate of PX4's to compare with");
  return std::nullopt;
}

}  // namespace ironbird::scenarios
