#include "simulator/environment/environment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace ironbird::simulator {
namespace {

constexpr double kRounding = 1e-12;

TEST(EnvironmentTest, PointsItsMagneticFieldByInclinationAndDeclination) {
  const Environment environment(EnvironmentParams{}, 1);
  const Vector3& m = environment.magnetic_field_N();
  EXPECT_NEAR(m.norm() / 50.7163e-6, 1.0, kRounding);
  EXPECT_NEAR(std::atan2(m.y(), m.x()), 0.1857972802, kRounding);
  EXPECT_NEAR(std::asin(m.z() / m.norm()), 1.139436457, kRounding);
}

TEST(EnvironmentTest, HasTheThinAirOfItsHome) {
  const Environment environment(EnvironmentParams{}, 1);
  EXPECT_NEAR(environment.air_density(0.0), 1.0694, 1e-3);  // 1387 m, the 1976 standard
  EXPECT_GT(environment.air_density(0.0), environment.air_density(100.0));
  EXPECT_EQ(environment.altitude(), 1387.0);
}

TEST(EnvironmentTest, BlowsSteadilyWhenToldSo) {
  EnvironmentParams params;
  params.wind.steady_N = {1.0, -2.0, 0.5};
  Environment environment(params, 1);
  EXPECT_EQ(environment.wind_N(), params.wind.steady_N);
  environment.advance(1.0, Vector3::Zero(), Vector3::Zero());
  EXPECT_EQ(environment.wind_N(), params.wind.steady_N);
}

TEST(EnvironmentTest, AddsWindAndTakesItBack) {
  Environment environment(EnvironmentParams{}, 1);
  const Vector3 storm(4.0, 0.0, -1.0);
  environment.add_wind(storm);
  EXPECT_EQ(environment.wind_N(), storm);
  environment.advance(0.1, Vector3::Zero(), Vector3::Zero());
  EXPECT_EQ(environment.wind_N(), storm);
  environment.add_wind(-storm);
  EXPECT_TRUE(environment.wind_N().isZero(0.0));
}

TEST(EnvironmentTest, DrawsItsConstantWindOncePerSeed) {
  EnvironmentParams params;
  params.wind.spread_N = {0.5, 0.5, 0.0};
  Environment environment(params, 1);
  const Vector3 drawn = environment.wind_N();
  EXPECT_EQ(drawn.z(), 0.0);
  environment.advance(10.0, Vector3::Zero(), Vector3::Zero());
  EXPECT_EQ(environment.wind_N(), drawn);
  EXPECT_EQ(Environment(params, 1).wind_N(), drawn);
  EXPECT_NE(Environment(params, 2).wind_N(), drawn);
  Vector3 square = Vector3::Zero();
  constexpr int kDraws = 4000;
  for (int seed = 0; seed < kDraws; ++seed) square += Environment(params, seed).wind_N().cwiseAbs2() / kDraws;
  constexpr double kFourSigma = 4.0 * 0.0224;  // sqrt(2/kDraws)
  EXPECT_NEAR(square.x() / 0.25, 1.0, kFourSigma);
  EXPECT_NEAR(square.y() / 0.25, 1.0, kFourSigma);
}

TEST(EnvironmentTest, GivesTheSameAirForTheSameSeed) {
  EnvironmentParams params;
  params.wind.gusts.amplitude = 3.0;
  params.wind.turbulence.wind_at_20_feet = 10.0;
  Environment a(params, 5), b(params, 5), c(params, 6);
  double apart = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p_N(0.0, 0.0, -10.0);
    const Vector3 v_N(1.0, 2.0, 0.0);
    for (Environment* environment : {&a, &b, &c}) environment->advance(2.5e-3, p_N, v_N);
    ASSERT_EQ(a.wind_N(), b.wind_N());
    apart = std::max(apart, (a.wind_N() - c.wind_N()).norm());
  }
  EXPECT_GT(apart, 0.1);
}

struct BadCase {
  const char* name;
  std::function<void(EnvironmentParams&)> spoil;
  const char* names;
};

class EnvironmentParamsTest : public ::testing::TestWithParam<BadCase> {};

TEST_P(EnvironmentParamsTest, RefusesWhatMakesNoSense) {
  EnvironmentParams params;
  GetParam().spoil(params);
  try {
    const Environment environment(params, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), ::testing::HasSubstr(GetParam().names));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, EnvironmentParamsTest,
    ::testing::Values(
        BadCase{"NoLatitude", [](EnvironmentParams& p) { p.home.latitude = 40.0; },
                "environment.home.latitude = 40 rad"},
        BadCase{"WindIsNoNumber", [](EnvironmentParams& p) { p.wind.steady_N.y() = NAN; },
                "environment.wind.steady_N[1]"},
        BadCase{"GustsWithoutInterval", [](EnvironmentParams& p) { p.wind.gusts.mean_interval = 0.0; },
                "mean_interval"},
        BadCase{"GustsBackwards", [](EnvironmentParams& p) { p.wind.gusts.shortest = 9.0; }, "shortest"},
        BadCase{"AntigravityAir", [](EnvironmentParams& p) { p.gravity = -9.81; }, "environment.gravity"}),
    [](const auto& case_) { return case_.param.name; });

}  // namespace
}  // namespace ironbird::simulator
