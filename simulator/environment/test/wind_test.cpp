#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "simulator/environment/gusts.hpp"
#include "simulator/environment/turbulence.hpp"

namespace ironbird::simulator {
namespace {

using std::numbers::pi;

constexpr double kLightWind = 7.7;  // m/s at 20 ft

TEST(TurbulenceScaleTest, AgreesWithTheSpecificationAtItsEnds) {
  // At 1000 ft the bracket 0.177 + 0.000823 h is one: all lengths are 1000 ft, all intensities equal.
  const TurbulenceScale top = low_altitude_scale(304.8, kLightWind);
  EXPECT_NEAR(top.length_horizontal, 304.8, 1e-9);
  EXPECT_NEAR(top.length_vertical, 304.8, 1e-9);
  EXPECT_NEAR(top.sigma_horizontal, 0.77, 1e-12);
  EXPECT_NEAR(top.sigma_vertical, 0.77, 1e-12);
  // At 20 ft: 20/(0.19346^1.2) = 143.6 ft and 0.1 W/(0.19346^0.4) = 0.1929 W.
  const TurbulenceScale low = low_altitude_scale(6.096, kLightWind);
  EXPECT_NEAR(low.length_horizontal / 0.3048, 143.6, 0.1);
  EXPECT_NEAR(low.length_vertical, 6.096, 1e-9);
  EXPECT_NEAR(low.sigma_horizontal / kLightWind, 0.1929, 1e-4);
  EXPECT_EQ(low_altitude_scale(0.0, kLightWind).length_vertical,
            low_altitude_scale(3.048, kLightWind).length_vertical);
}

constexpr double kHeight = 20.0;    // m
constexpr double kAirspeed = 10.0;  // m/s
constexpr double kStep = 0.05;      // s

std::vector<Vector3> record(int count, std::uint64_t seed) {
  Turbulence turbulence({.wind_at_20_feet = kLightWind}, Vector3::Zero(), seed);
  std::vector<Vector3> wind;
  wind.reserve(count);
  for (int i = 0; i < count; ++i) {
    turbulence.advance(kStep, kHeight, kAirspeed);
    wind.push_back(turbulence.wind_N());
  }
  return wind;
}

TEST(TurbulenceTest, HasTheVarianceOfTheSpecification) {
  const int count = 400'000;
  const std::vector<Vector3> wind = record(count, 3);
  Vector3 square = Vector3::Zero();
  for (const Vector3& w : wind) square += w.cwiseAbs2() / count;
  const TurbulenceScale scale = low_altitude_scale(kHeight, kLightWind);
  // The slowest component has a correlation time of L/V = 9 s: 20 000 s hold about 1 100 independent pairs.
  constexpr double kFourSigma = 4.0 * 0.043;
  EXPECT_NEAR(square.x() / std::pow(scale.sigma_horizontal, 2), 1.0, kFourSigma);
  EXPECT_NEAR(square.y() / std::pow(scale.sigma_horizontal, 2), 1.0, kFourSigma);
  EXPECT_NEAR(square.z() / std::pow(scale.sigma_vertical, 2), 1.0, kFourSigma);
}

/// Two-sided power spectral density of one axis at `omega`, rad/s, averaged over segments.
double spectrum(const std::vector<Vector3>& wind, int axis, double omega) {
  const int segment = 4000;  // 200 s
  double sum = 0.0;
  int count = 0;
  for (std::size_t begin = 0; begin + segment <= wind.size(); begin += segment) {
    std::complex<double> transform = 0.0;
    for (int i = 0; i < segment; ++i) {
      const double window =
          std::sqrt(2.0 / 3.0) * (1.0 - std::cos(2.0 * pi * i / segment));  // Hann, unit power
      transform += window * wind[begin + i][axis] * std::polar(1.0, -omega * i * kStep);
    }
    sum += std::norm(transform) * kStep / segment;
    ++count;
  }
  return sum / count;
}

TEST(TurbulenceTest, HasDrydensSpectra) {
  const std::vector<Vector3> wind = record(800'000, 4);
  const TurbulenceScale scale = low_altitude_scale(kHeight, kLightWind);
  constexpr double kFourSigma = 4.0 / 14.1;  // two hundred segments
  for (const double cycles : {20.0, 60.0, 200.0}) {
    const double omega = 2.0 * pi * cycles / (4000 * kStep);
    const double T_h = scale.length_horizontal / kAirspeed;
    const double T_w = scale.length_vertical / kAirspeed;
    const auto along = [&](double T, double sigma) {
      return 2.0 * sigma * sigma * T / (1.0 + std::pow(T * omega, 2));
    };
    const auto across = [&](double T, double sigma) {
      const double x = std::pow(T * omega, 2);
      return sigma * sigma * T * (1.0 + 3.0 * x) / std::pow(1.0 + x, 2);
    };
    EXPECT_NEAR(spectrum(wind, 0, omega) / along(T_h, scale.sigma_horizontal), 1.0, kFourSigma) << cycles;
    EXPECT_NEAR(spectrum(wind, 1, omega) / across(T_h, scale.sigma_horizontal), 1.0, kFourSigma) << cycles;
    EXPECT_NEAR(spectrum(wind, 2, omega) / across(T_w, scale.sigma_vertical), 1.0, kFourSigma) << cycles;
  }
}

TEST(TurbulenceTest, BlowsAlongTheMeanWind) {
  // The along and across components have their own streams, so turning the mean wind by a right angle turns
  // the turbulence with it.
  Turbulence north({.wind_at_20_feet = kLightWind}, {5.0, 0.0, 0.0}, 9);
  Turbulence east({.wind_at_20_feet = kLightWind}, {0.0, 5.0, 0.0}, 9);
  for (int i = 0; i < 100; ++i) {
    north.advance(kStep, kHeight, kAirspeed);
    east.advance(kStep, kHeight, kAirspeed);
    ASSERT_EQ(east.wind_N(), Vector3(-north.wind_N().y(), north.wind_N().x(), north.wind_N().z()));
  }
}

TEST(TurbulenceTest, IsSmoothOverShortSteps) {
  // The filter's series for short steps must meet its closed form: the same variance of change on both sides.
  const TurbulenceScale scale = low_altitude_scale(kHeight, kLightWind);
  for (const double h : {0.0099, 0.0101}) {
    Turbulence turbulence({.wind_at_20_feet = kLightWind}, Vector3::Zero(), 5);
    const double dt = h * scale.length_horizontal / kAirspeed;
    double change = 0.0;
    const int count = 100'000;
    double last = 0.0;
    for (int i = 0; i <= count; ++i) {
      turbulence.advance(dt, kHeight, kAirspeed);
      if (i > 0) change += std::pow(turbulence.wind_N().y() - last, 2) / count;
      last = turbulence.wind_N().y();
    }
    // Structure function of exp(-r)(1 - r/2): 2 sigma^2 (1 - R(h)).
    const double structure = 2.0 * (1.0 - std::exp(-h) * (1.0 - 0.5 * h));
    EXPECT_NEAR(change / (std::pow(scale.sigma_horizontal, 2) * structure), 1.0, 0.02) << h;
  }
}

TEST(GustsTest, HaveTheShapeOfOneMinusCosine) {
  GustParams params{
      .amplitude = 6.0, .mean_interval = 1e5, .shortest = 2.0, .longest = 2.0, .direction_spread = 0.0};
  Gusts gusts(params, {3.0, 4.0, 0.0}, 11);
  double begin = -1.0;
  double t = 0.0;
  constexpr double kFine = 1e-3;
  gusts.advance(0.0);
  // Find the beginning of the first gust by large steps, then run a second instance up to it by small ones.
  Gusts probe = gusts;
  while (probe.wind_N().isZero()) {
    gusts = probe;
    begin = t;
    probe.advance(0.5);
    t += 0.5;
  }
  ASSERT_GE(begin, 0.0);
  double duration = 0.0;
  double peak = 0.0;
  double impulse = 0.0;
  for (int i = 0; i < 3000; ++i) {
    gusts.advance(kFine);
    const double speed = gusts.wind_N().norm();
    EXPECT_LT((gusts.wind_N() - speed * Vector3(0.6, 0.8, 0.0)).norm(), 1e-12);
    duration += speed > 0.0 ? kFine : 0.0;
    peak = std::max(peak, speed);
    impulse += speed * kFine;
  }
  EXPECT_NEAR(duration, 2.0, 3.0 * kFine);
  EXPECT_NEAR(peak, 6.0, 1e-4);
  EXPECT_NEAR(impulse, 0.5 * 6.0 * 2.0, 1e-4);
}

TEST(GustsTest, ComeAsOftenAsTheyShould) {
  GustParams params{.amplitude = 1.0, .mean_interval = 5.0, .shortest = 0.01, .longest = 0.01};
  Gusts gusts(params, {1.0, 0.0, 0.0}, 12);
  int begun = 0;
  bool blowing = false;
  for (int i = 0; i < 20'000'000; ++i) {
    gusts.advance(2e-3);
    const bool now = !gusts.wind_N().isZero();
    begun += now && !blowing;
    blowing = now;
  }
  constexpr double kFourSigma = 4.0 / 89.0;  // 8 000 of them
  EXPECT_NEAR(begun / 8000.0, 1.0, kFourSigma);
}

TEST(GustsTest, DoNotDependOnTheStep) {
  GustParams params{.amplitude = 2.0, .amplitude_spread = 0.5};
  Gusts coarse(params, {1.0, 0.0, 0.0}, 13);
  Gusts fine(params, {1.0, 0.0, 0.0}, 13);
  constexpr double kStepRounding = 1e-9;
  for (int i = 0; i < 4000; ++i) {
    coarse.advance(0.015625);
    for (int k = 0; k < 4; ++k) fine.advance(0.00390625);
    ASSERT_LT((coarse.wind_N() - fine.wind_N()).norm(), kStepRounding);
  }
}

TEST(GustsTest, AreAbsentByDefault) {
  Gusts gusts(GustParams{}, Vector3::Zero(), 1);
  gusts.advance(1000.0);
  EXPECT_TRUE(gusts.wind_N().isZero(0.0));
}

}  // namespace
}  // namespace ironbird::simulator
