#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/sensors/airspeed.hpp"
#include "simulator/sensors/barometer.hpp"
#include "simulator/sensors/battery_monitor.hpp"
#include "simulator/sensors/gnss.hpp"
#include "simulator/sensors/imu.hpp"
#include "simulator/sensors/magnetometer.hpp"
#include "simulator/sensors/range_finder.hpp"

namespace ironbird::simulator {
namespace {

using AngleAxis = Eigen::AngleAxis<double>;

constexpr double kGravity = 9.80665;
constexpr double kPeriod = 0.0025;
constexpr double kRoundOff = 1e-12;
constexpr Time kNow = std::chrono::milliseconds(250);
const FaultState kNoSensorFaults;

Truth at_rest() {
  Truth truth;
  truth.f_B = Vector3(0.0, 0.0, -kGravity);
  return truth;
}

TEST(ImuTest, ReadsMinusGravityAtRest) {
  Imu imu(ImuParams{}, SensorSite{}, kPeriod, 1);
  const ImuReading reading = imu.measure(at_rest(), kNow, kNoSensorFaults, true);
  EXPECT_EQ(reading.f_B, Vector3(0.0, 0.0, -kGravity));
  EXPECT_EQ(reading.w_NB_B, Vector3(Vector3::Zero()));
  EXPECT_EQ(reading.taken, kNow);
}

TEST(ImuTest, FeelsTheCentripetalAndTheTangentialAccelerationOfItsLeverArm) {
  ImuParams params;
  params.mounting.p_BS_B = Vector3(0.2, 0.0, 0.0);
  Truth truth = at_rest();
  truth.w_NB_B = Vector3(0.0, 0.0, 3.0);
  truth.w_dot_NB_B = Vector3(0.0, 0.0, 5.0);
  Imu imu(params, SensorSite{}, kPeriod, 1);
  const Vector3 extra = imu.measure(truth, kNow, kNoSensorFaults, true).f_B - truth.f_B;
  // On a turntable: w^2 r towards the axis, w_dot r along the turn.
  EXPECT_NEAR(extra.x(), -9.0 * 0.2, kRoundOff);
  EXPECT_NEAR(extra.y(), 5.0 * 0.2, kRoundOff);
  EXPECT_NEAR(extra.z(), 0.0, kRoundOff);
}

/// The specific force of a point of a rigid body, from second differences of its position.
TEST(ImuTest, AgreesWithThePathOfItsPointInATumble) {
  const Vector3 w_B(1.1, -0.7, 2.3);
  const Vector3 r_B(0.1, -0.2, 0.3);
  const auto p_N = [&](double t) -> Vector3 { return AngleAxis(w_B.norm() * t, w_B.normalized()) * r_B; };
  constexpr double kStep = 1e-4;
  constexpr double kDifferenceTolerance = 1e-5;  // second difference: step^2 in truth, round-off / step^2
  const Vector3 a_N = (p_N(kStep) - 2.0 * p_N(0.0) + p_N(-kStep)) / (kStep * kStep);

  ImuParams params;
  params.mounting.p_BS_B = r_B;
  Truth truth;  // falls freely: no specific force at the centre of mass
  truth.w_NB_B = w_B;
  Imu imu(params, SensorSite{}, kPeriod, 1);
  EXPECT_NEAR((imu.measure(truth, kNow, kNoSensorFaults, true).f_B - a_N).norm(), 0.0, kDifferenceTolerance);
}

TEST(ImuTest, ReadsInItsOwnAxes) {
  ImuParams params;
  params.mounting.heading = std::numbers::pi / 2.0;  // Sx along By
  Truth truth = at_rest();
  truth.w_NB_B = Vector3(0.1, 0.2, 0.3);
  Imu imu(params, SensorSite{}, kPeriod, 1);
  const Vector3 w_S = imu.measure(truth, kNow, kNoSensorFaults, true).w_NB_B;
  EXPECT_NEAR((w_S - Vector3(0.2, -0.1, 0.3)).norm(), 0.0, kRoundOff);
}

TEST(ImuTest, AddsTheBiasesOfFaults) {
  FaultState faults;
  faults.accelerometer_bias = Vector3(0.1, 0.2, 0.3);
  faults.gyro_bias = Vector3(0.4, 0.5, 0.6);
  Imu imu(ImuParams{}, SensorSite{}, kPeriod, 1);
  const ImuReading reading = imu.measure(at_rest(), kNow, faults, true);
  EXPECT_EQ(reading.f_B, Vector3(0.1, 0.2, 0.3 - kGravity));
  EXPECT_EQ(reading.w_NB_B, faults.gyro_bias);
}

TEST(ImuTest, ShakesWithTheSquareOfRotorSpeed) {
  ImuParams params;
  params.accelerometer_vibration = 1e-6;
  Truth slow = at_rest(), fast = at_rest();
  for (int rotor = 0; rotor < 4; ++rotor) {
    slow.rotor_speed[static_cast<std::size_t>(rotor)] = 300.0;
    fast.rotor_speed[static_cast<std::size_t>(rotor)] = 600.0;
  }
  Imu still_imu(params, SensorSite{}, kPeriod, 1);
  EXPECT_EQ(still_imu.measure(at_rest(), kNow, kNoSensorFaults, true).f_B, at_rest().f_B);

  constexpr int kSamples = 20000;
  constexpr double kFiveSigma = 0.025;  // 5 / sqrt(2 * kSamples)
  const auto sigma_of = [&](const Truth& truth) {
    Imu imu(params, SensorSite{}, kPeriod, 1);
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const double x = imu.measure(truth, kNow, kNoSensorFaults, true).f_B.x();
      sum += x * x;
    }
    return std::sqrt(sum / kSamples);
  };
  EXPECT_NEAR(sigma_of(slow) / (1e-6 * 2.0 * 300.0 * 300.0), 1.0, kFiveSigma);
  EXPECT_NEAR(sigma_of(fast) / (1e-6 * 2.0 * 600.0 * 600.0), 1.0, kFiveSigma);
}

TEST(ImuTest, HasWhiteNoiseOnlyWhileArmedWhenAskedTo) {
  ImuParams params;
  params.noise_only_when_armed = true;
  params.accelerometer.noise_sigma = 0.2;
  Imu imu(params, SensorSite{}, kPeriod, 1);
  EXPECT_EQ(imu.measure(at_rest(), kNow, kNoSensorFaults, false).f_B, at_rest().f_B);
  EXPECT_NE(imu.measure(at_rest(), kNow, kNoSensorFaults, true).f_B, at_rest().f_B);
}

TEST(ImuTest, ReadsExactlyGravityBelowTheRestSpeedWhenAskedTo) {
  ImuParams params;
  params.rest_speed = 0.05;
  SensorSite site;
  site.gravity = 9.81;
  Truth truth = at_rest();
  truth.q_NB = Quaternion(AngleAxis(0.3, Vector3::UnitX()));
  truth.f_B = Vector3(1.0, 2.0, 3.0);
  truth.v_NB_N = Vector3(0.03, 0.03, 0.0);
  Imu imu(params, site, kPeriod, 1);
  const Vector3 expected(0.0, -9.81 * std::sin(0.3), -9.81 * std::cos(0.3));
  EXPECT_NEAR((imu.measure(truth, kNow, kNoSensorFaults, true).f_B - expected).norm(), 0.0, kRoundOff);
  truth.v_NB_N = Vector3(0.06, 0.0, 0.0);
  EXPECT_EQ(imu.measure(truth, kNow, kNoSensorFaults, true).f_B, truth.f_B);
}

TEST(MagnetometerTest, SeesTheEarthsFieldTurnAgainstTheVehicle) {
  SensorSite site;
  site.magnetic_field_N = Vector3(20e-6, 0.0, 45e-6);
  Truth truth;
  truth.q_NB = Quaternion(AngleAxis(std::numbers::pi / 2.0, Vector3::UnitZ()));  // heads east
  Magnetometer magnetometer(MagnetometerParams{}, site, 0.01, 1);
  const Vector3 m_B = magnetometer.measure(truth, kNow, kNoSensorFaults, true).m_B;
  EXPECT_NEAR((m_B - Vector3(0.0, -20e-6, 45e-6)).norm(), 0.0, kRoundOff * 50e-6);
}

TEST(MagnetometerTest, AddsSoftIronHardIronAndTheFieldOfTheCurrent) {
  SensorSite site;
  site.magnetic_field_N = Vector3(20e-6, 0.0, 40e-6);
  MagnetometerParams params;
  params.soft_iron << 1.1, 0.0, 0.05, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0;
  params.hard_iron_B = Vector3(1e-6, 2e-6, 3e-6);
  params.current_coupling_B = Vector3(0.0, 1e-8, 0.0);
  Truth truth;
  truth.battery_current = 30.0;
  FaultState faults;
  faults.mag_bias = Vector3(0.0, 0.0, 5e-6);
  Magnetometer magnetometer(params, site, 0.01, 1);
  const Vector3 m_B = magnetometer.measure(truth, kNow, faults, true).m_B;
  const Vector3 expected(22e-6 + 2e-6 + 1e-6, 2e-6 + 0.3e-6, 40e-6 + 3e-6 + 5e-6);
  EXPECT_NEAR((m_B - expected).norm(), 0.0, kRoundOff * 50e-6);
}

TEST(BarometerTest, ReadsTheStandardAtmosphereAtTheHomesAltitude) {
  SensorSite site;
  site.altitude = 1000.0;
  Truth truth;
  truth.p_NB_N.z() = -500.0;
  Barometer barometer(BarometerParams{}, site, 0.02, 1);
  // U.S. Standard Atmosphere 1976, table: 1500 m geometric, 84 560 Pa (five digits).
  EXPECT_NEAR(barometer.measure(truth, kNow, kNoSensorFaults, true).pressure, 84560.0, 5.0);
}

TEST(BarometerTest, RepeatsTheReferenceFormulaWhenAskedTo) {
  SensorSite site;
  site.altitude = 1387.0;
  BarometerParams params;
  params.model = PressureModel::kReference;
  Truth truth;
  truth.p_NB_N.z() = -13.0;
  Barometer barometer(params, site, 0.01, 1);
  const double expected = 101325.0 * std::exp(5.2553 * std::log(1.0 - 2.25694e-5 * 1400.0));
  constexpr double kRoundOffOfLogarithm = 1e-8;
  EXPECT_NEAR(barometer.measure(truth, kNow, kNoSensorFaults, true).pressure, expected, kRoundOffOfLogarithm);
}

TEST(BarometerTest, IsDisturbedByWashWindAndFaults) {
  BarometerParams params;
  params.rotor_wash = -5e-6;
  params.wind_coefficient = -0.4;
  Truth truth;
  truth.air_density = 1.1;
  Barometer barometer(params, SensorSite{}, 0.02, 1);
  const double still = barometer.measure(truth, kNow, kNoSensorFaults, true).pressure;
  truth.rotor_speed = {400.0, 400.0, 500.0, 500.0};
  truth.v_NB_N = Vector3(3.0, 0.0, 0.0);
  truth.wind_N = Vector3(0.0, 4.0, 0.0);
  FaultState faults;
  faults.baro_bias = 100.0;
  const double disturbed = barometer.measure(truth, kNow, faults, true).pressure;
  constexpr double kRoundOffOfPressure = 1e-9;
  EXPECT_NEAR(disturbed - still, -5e-6 * 820e3 - 0.4 * 0.5 * 1.1 * 25.0 + 100.0, kRoundOffOfPressure);
}

TEST(GnssTest, PutsMetresOnTheSphereTheAutopilotUses) {
  SensorSite site;
  site.latitude = 0.7;
  site.longitude = -1.9;
  site.altitude = 1387.0;
  Truth truth;
  truth.p_NB_N = Vector3(100.0, -200.0, -30.0);
  truth.v_NB_N = Vector3(1.0, 2.0, 3.0);
  Gnss gnss(GnssParams{}, site, 0.1, 1);
  const GnssReading reading = gnss.measure(truth, kNow, kNoSensorFaults, true);
  constexpr double kRoundOffOfMetres = 2e-9;
  EXPECT_NEAR((reading.latitude - 0.7) * 6378145.0, 100.0, kRoundOffOfMetres);
  EXPECT_NEAR((reading.longitude + 1.9) * 6378145.0 * std::cos(0.7), -200.0, kRoundOffOfMetres);
  EXPECT_NEAR(reading.altitude, 1417.0, kRoundOffOfMetres);
  EXPECT_EQ(reading.v_NB_N, truth.v_NB_N);
}

TEST(GnssTest, StaysWithinHalfATurnAtTheDateLine) {
  SensorSite site;
  site.latitude = 0.0;
  site.longitude = std::numbers::pi - 1e-6;  // 6 m before it
  Truth truth;
  truth.p_NB_N.y() = 50.0;
  Gnss gnss(GnssParams{}, site, 0.1, 1);
  const double beyond = 50.0 / kEarthRadius - 1e-6;
  EXPECT_NEAR(gnss.measure(truth, kNow, kNoSensorFaults, true).longitude, -std::numbers::pi + beyond, 1e-14);
}

TEST(GnssTest, MeasuresItsAntenna) {
  GnssParams params;
  params.p_BA_B = Vector3(0.0, 0.0, -0.5);
  Truth truth;
  truth.q_NB = Quaternion(AngleAxis(std::numbers::pi / 2.0, Vector3::UnitZ()));  // heads east
  truth.w_NB_B = Vector3(0.0, 2.0, 0.0);                                         // pitches up at 2 rad/s
  Gnss gnss(params, SensorSite{}, 0.1, 1);
  const GnssReading reading = gnss.measure(truth, kNow, kNoSensorFaults, true);
  EXPECT_NEAR(reading.altitude, SensorSite{}.altitude + 0.5, kRoundOff * 2e3);
  // The antenna above moves backwards, to the west.
  EXPECT_NEAR((reading.v_NB_N - Vector3(0.0, -1.0, 0.0)).norm(), 0.0, kRoundOff);
}

TEST(GnssTest, JumpsWithAFault) {
  FaultState faults;
  faults.gnss_jump_N = Vector3(10.0, 0.0, -4.0);
  Gnss gnss(GnssParams{}, SensorSite{}, 0.1, 1);
  const GnssReading reading = gnss.measure(Truth{}, kNow, faults, true);
  constexpr double kRoundOffOfMetres = 2e-9;
  EXPECT_NEAR((reading.latitude - SensorSite{}.latitude) * kEarthRadius, 10.0, kRoundOffOfMetres);
  EXPECT_NEAR(reading.altitude - SensorSite{}.altitude, 4.0, kRoundOffOfMetres);
}

struct RangeCase {
  const char* name;
  double height, roll, expected;
};

class RangeFinderTest : public ::testing::TestWithParam<RangeCase> {};

TEST_P(RangeFinderTest, ReadsAlongItsAxisWithinItsLimits) {
  RangeFinderParams params;
  params.minimum = 0.2;
  params.maximum = 8.0;
  Truth truth;
  truth.p_NB_N.z() = -GetParam().height;
  truth.q_NB = Quaternion(AngleAxis(GetParam().roll, Vector3::UnitX()));
  RangeFinder range_finder(params, SensorSite{}, 0.05, 1);
  EXPECT_NEAR(range_finder.measure(truth, kNow, kNoSensorFaults, true).range, GetParam().expected, kRoundOff);
}

INSTANTIATE_TEST_SUITE_P(Poses, RangeFinderTest,
                         ::testing::Values(RangeCase{"Level", 3.0, 0.0, 3.0},
                                           RangeCase{"Tilted", 3.0, std::numbers::pi / 3.0, 6.0},
                                           RangeCase{"TooFar", 9.0, 0.0, 8.0},
                                           RangeCase{"TooFarByTilt", 5.0, std::numbers::pi / 3.0, 8.0},
                                           RangeCase{"Horizontal", 3.0, std::numbers::pi / 2.0, 8.0},
                                           RangeCase{"Inverted", 3.0, std::numbers::pi, 8.0},
                                           RangeCase{"TooNear", 0.1, 0.0, 0.2}),
                         [](const auto& sample) { return sample.param.name; });

TEST(RangeFinderReferenceTest, ReadsTheHeightAndNoNoiseOutsideItsLimits) {
  RangeFinderParams params;
  params.minimum = 0.25;
  params.maximum = 8.0;
  params.slant = false;
  params.error.noise_sigma = 0.03;
  Truth truth;
  truth.p_NB_N.z() = -9.0;
  RangeFinder range_finder(params, SensorSite{}, 0.05, 1);
  EXPECT_EQ(range_finder.measure(truth, kNow, kNoSensorFaults, true).range, 8.0);
  truth.p_NB_N.z() = -3.0;
  truth.q_NB = Quaternion(AngleAxis(1.0, Vector3::UnitX()));
  const double inside = range_finder.measure(truth, kNow, kNoSensorFaults, true).range;
  EXPECT_NE(inside, 3.0);
  EXPECT_NEAR(inside, 3.0, 5.0 * 0.03);
}

TEST(AirspeedTest, MeasuresTheDynamicPressureAlongTheNose) {
  Truth truth;
  truth.air_density = 1.2;
  truth.q_NB = Quaternion(AngleAxis(std::numbers::pi / 2.0, Vector3::UnitZ()));  // heads east
  truth.v_NB_N = Vector3(5.0, 8.0, 0.0);
  truth.wind_N = Vector3(0.0, -2.0, 0.0);
  AirspeedParams params;
  Airspeed airspeed(params, SensorSite{}, 0.01, 1);
  EXPECT_NEAR(airspeed.measure(truth, kNow, kNoSensorFaults, true).differential_pressure, 60.0,
              60.0 * kRoundOff);
  truth.v_NB_N.y() = -12.0;
  EXPECT_NEAR(airspeed.measure(truth, kNow, kNoSensorFaults, true).differential_pressure, -60.0,
              60.0 * kRoundOff);
  params.keeps_sign = false;
  Airspeed reference(params, SensorSite{}, 0.01, 1);
  EXPECT_NEAR(reference.measure(truth, kNow, kNoSensorFaults, true).differential_pressure, 60.0,
              60.0 * kRoundOff);
}

TEST(BatteryMonitorTest, ReadsTheBatteryOrAFixedValue) {
  Truth truth;
  truth.battery_voltage = 22.2;
  truth.battery_current = 30.0;
  BatteryMonitorParams params;
  params.current.scale = 0.1;
  const BatteryReading reading =
      BatteryMonitor(params, SensorSite{}, 0.1, 1).measure(truth, kNow, kNoSensorFaults, true);
  EXPECT_EQ(reading.voltage, 22.2);
  EXPECT_NEAR(reading.current, 33.0, 33.0 * kRoundOff);
  params.fixed_voltage = 23.0;
  EXPECT_EQ(BatteryMonitor(params, SensorSite{}, 0.1, 1).measure(truth, kNow, kNoSensorFaults, true).voltage,
            23.0);
}

}  // namespace
}  // namespace ironbird::simulator
