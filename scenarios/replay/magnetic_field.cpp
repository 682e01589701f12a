#include "scenarios/replay/magnetic_field.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "scenarios/replay/wmm_coefficients.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Vector3;

constexpr double kReferenceRadius = 6'371'200.0;  // m, of the model
constexpr double kSemiMajor = 6'378'137.0;        // m, WGS 84
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kYears = 5.0;  // that an edition is meant for
constexpr double kTeslaPerNanotesla = 1e-9;

/// Where an observer is, seen from the earth's centre.
struct Geocentric {
  double latitude;
  double radius;
};

Geocentric geocentric(double latitude, double altitude) {
  const double e2 = kFlattening * (2.0 - kFlattening);
  const double sine = std::sin(latitude);
  const double prime_vertical = kSemiMajor / std::sqrt(1.0 - e2 * sine * sine);
  const double across = (prime_vertical + altitude) * std::cos(latitude);
  const double along = (prime_vertical * (1.0 - e2) + altitude) * sine;
  return {std::atan2(along, across), std::hypot(along, across)};
}

constexpr std::size_t place(int n, int m) {
  return static_cast<std::size_t>(n * (n + 1) / 2 + m);
}

/// Schmidt semi-normalised associated Legendre functions of the sine of the latitude, and their derivatives
/// with respect to the latitude.
struct Legendre {
  static constexpr std::size_t kSize = place(kWmmDegree + 1, 0);
  std::array<double, kSize> value{};
  std::array<double, kSize> slope{};

  explicit Legendre(double latitude) {
    const double sine = std::sin(latitude);
    const double cosine = std::cos(latitude);
    value[0] = 1.0;
    for (int n = 1; n <= kWmmDegree; ++n) {
      for (int m = 0; m <= n; ++m) {
        if (m == n) {
          const double ratio = n == 1 ? 1.0 : std::sqrt((2.0 * n - 1.0) / (2.0 * n));
          value[place(n, n)] = ratio * cosine * value[place(n - 1, n - 1)];
          slope[place(n, n)] =
              ratio * (cosine * slope[place(n - 1, n - 1)] - sine * value[place(n - 1, n - 1)]);
          continue;
        }
        const double norm = 1.0 / std::sqrt(static_cast<double>(n * n - m * m));
        const double first = (2.0 * n - 1.0) * norm;
        const double second = std::sqrt(static_cast<double>((n - 1) * (n - 1) - m * m)) * norm;
        const std::size_t one = place(n - 1, m);
        const bool has_two = n - 2 >= m;
        const double two = has_two ? value[place(n - 2, m)] : 0.0;
        const double two_slope = has_two ? slope[place(n - 2, m)] : 0.0;
        value[place(n, m)] = first * sine * value[one] - second * two;
        slope[place(n, m)] = first * (sine * slope[one] + cosine * value[one]) - second * two_slope;
      }
    }
  }
};

const WmmEdition& edition_for(double year) {
  const WmmEdition* best = &kWmmEditions.front();
  for (const WmmEdition& edition : kWmmEditions) {
    if (edition.epoch <= year) best = &edition;
  }
  return *best;
}

}  // namespace

MagneticField magnetic_field(double latitude, double longitude, double altitude, double year) {
  const WmmEdition& edition = edition_for(year);
  constexpr double kFarthest = 10.0;  // years: linear change beyond is no change that there was
  const double age = std::clamp(year - edition.epoch, -kFarthest, kFarthest);
  // At a pole east and west are nowhere; close by they are good enough.
  constexpr double kPole = 1e-9;
  constexpr double kQuarter = std::numbers::pi / 2.0;
  const double bounded = std::clamp(latitude, -kQuarter + kPole, kQuarter - kPole);
  const Geocentric here = geocentric(bounded, altitude);
  const Legendre p(here.latitude);
  double north = 0.0;
  double east = 0.0;
  double down = 0.0;
  double shrink = std::pow(kReferenceRadius / here.radius, 2.0);
  for (int n = 1; n <= kWmmDegree; ++n) {
    shrink *= kReferenceRadius / here.radius;
    for (int m = 0; m <= n; ++m) {
      const WmmTerm& term = edition.terms[place(n, m) - 1];
      const double g = term.g + age * term.g_dot;
      const double h = term.h + age * term.h_dot;
      const double in_phase = g * std::cos(m * longitude) + h * std::sin(m * longitude);
      const double quadrature = g * std::sin(m * longitude) - h * std::cos(m * longitude);
      north -= shrink * in_phase * p.slope[place(n, m)];
      east += shrink * m * quadrature * p.value[place(n, m)] / std::cos(here.latitude);
      down -= shrink * (n + 1) * in_phase * p.value[place(n, m)];
    }
  }
  const double turn = here.latitude - bounded;
  MagneticField field;
  field.b_N = kTeslaPerNanotesla * Vector3(north * std::cos(turn) - down * std::sin(turn), east,
                                           north * std::sin(turn) + down * std::cos(turn));
  field.declination = std::atan2(field.b_N.y(), field.b_N.x());
  field.inclination = std::atan2(field.b_N.z(), std::hypot(field.b_N.x(), field.b_N.y()));
  field.strength = field.b_N.norm();
  field.edition = static_cast<int>(edition.epoch);
  field.current = year >= edition.epoch && year < edition.epoch + kYears;
  return field;
}

double newest_epoch() {
  return kWmmEditions.back().epoch;
}

double decimal_year(double unix_time) {
  using namespace std::chrono;
  const sys_days day = floor<days>(sys_seconds(seconds(static_cast<std::int64_t>(unix_time))));
  const year this_year = year_month_day(day).year();
  const sys_days begin = this_year / January / 1;
  const sys_days end = (this_year + years(1)) / January / 1;
  const double passed = unix_time - static_cast<double>(begin.time_since_epoch().count()) * 86400.0;
  const double whole = static_cast<double>((end - begin).count()) * 86400.0;
  return static_cast<int>(this_year) + passed / whole;
}

}  // namespace ironbird::scenarios
