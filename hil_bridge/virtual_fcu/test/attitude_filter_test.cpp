#include "hil_bridge/virtual_fcu/attitude_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

using Quaternion = Eigen::Quaterniond;
using Vector3 = Eigen::Vector3d;

constexpr std::uint64_t kTickUs = 2500;
constexpr double kFilterDt = 0.0025;
constexpr double kG = 9.80665;
// A second of float32 steps: each rounds by 6e-8, gains near 1 let 400 of them add up to a few 1e-6.
constexpr double kSinglePrecision = 1e-5;

/// Constants of the filter as numbers, for the independent implementation.
struct Settings {
  double acc_lpf = 0.5;
  double gyro_xy_lpf = 0.3;
  double gyro_z_lpf = 0.3;
  double acc_kp = 0.5;
  double ki = 0.01;
  double margin = 0.1;
  double init_s = 3.0;
  bool quadratic = true;
  bool sequential = true;
  bool closed_form = true;
};

/// The same filter again: double precision, rotations by Eigen, written from the description only.
class ReferenceFilter {
 public:
  explicit ReferenceFilter(const Settings& settings) : s_(settings) {}

  void step(const Vector3& f, const Vector3& w, double t) {
    a_ = (1.0 - s_.acc_lpf) * f + s_.acc_lpf * a_;
    const Vector3 alpha(s_.gyro_xy_lpf, s_.gyro_xy_lpf, s_.gyro_z_lpf);
    w_ = ((Vector3::Ones() - alpha).array() * w.array() + alpha.array() * w_.array()).matrix();
    Vector3 error = Vector3::Zero();
    double kp = 0.0;
    if (std::fabs(a_.norm() / kG - 1.0) < s_.margin) {
      const Quaternion q_a = Quaternion::FromTwoVectors(-Vector3::UnitZ(), a_.normalized());
      const Quaternion tilt = q_ * q_a;
      error = Vector3(-2.0 * tilt.w() * tilt.x(), -2.0 * tilt.w() * tilt.y(), 0.0);
      kp = s_.acc_kp;
    }
    const double boost = t < s_.init_s ? 10.0 : 1.0;
    if (boost > 1.0) kp = 10.0 * s_.acc_kp;
    b_ -= boost * s_.ki * error * kFilterDt;
    Vector3 smooth = w_;
    if (s_.quadratic) {
      smooth = (5.0 * w_ + 8.0 * w1_ - w2_) / 12.0;
      w2_ = w1_;
      w1_ = w_;
    }
    propagate(smooth - b_ + kp * error);
  }

  const Quaternion& q() const { return q_; }
  const Vector3& bias() const { return b_; }
  Vector3 rate() const { return w_ - b_; }

 private:
  void propagate(const Vector3& w) {
    if (w.norm() == 0.0) return;
    const double half = 0.5 * w.norm() * kFilterDt;
    const double c = s_.closed_form ? std::cos(half) : 1.0;
    const double s = s_.closed_form ? std::sin(half) / w.norm() : 0.5 * kFilterDt;
    Quaternion n = q_;
    const Quaternion old = q_;
    // Which earlier components a component sees: its own updated ones, or the old ones.
    const Quaternion& seen = s_.sequential && s_.closed_form ? n : old;
    n.w() = c * seen.w() + s * (-w.x() * seen.x() - w.y() * seen.y() - w.z() * seen.z());
    n.x() = c * seen.x() + s * (w.x() * seen.w() + w.z() * seen.y() - w.y() * seen.z());
    n.y() = c * seen.y() + s * (w.y() * seen.w() - w.z() * seen.x() + w.x() * seen.z());
    n.z() = c * seen.z() + s * (w.z() * seen.w() + w.y() * seen.x() - w.x() * seen.y());
    n.normalize();
    if (n.w() < 0.0) n.coeffs() = -n.coeffs();
    q_ = n;
  }

  Settings s_;
  Quaternion q_ = Quaternion::Identity();
  Vector3 b_ = Vector3::Zero();
  Vector3 a_ = {0.0, 0.0, -kG};
  Vector3 w_ = Vector3::Zero();
  Vector3 w1_ = Vector3::Zero();
  Vector3 w2_ = Vector3::Zero();
};

class AttitudeFilterTest : public ::testing::Test {
 protected:
  AttitudeFilterTest() { restart(); }
  void restart() {
    filter = AttitudeFilter();
    filter.configure(parameters);
    filter.reset();
    now_us = 0;
    step({0.0, 0.0, -kG}, Vector3::Zero());  // starts the clock
  }
  void step(const Vector3& f, const Vector3& w) {
    now_us += kTickUs;
    const auto single = [](const Vector3& v) {
      return Triple{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
    };
    filter.step({.stamp_us = now_us, .acceleration = single(f), .angular_velocity = single(w)},
                static_cast<float>(kFilterDt));
  }
  /// A vigorous, smooth motion: rates of radians per second and accelerations inside and outside the margin.
  static Vector3 wild_rate(double t) {
    return {2.0 * std::sin(9.0 * t), 1.5 * std::cos(7.0 * t), 1.0 + std::sin(3.0 * t)};
  }
  static Vector3 wild_force(double t) {
    return {2.0 * std::sin(5.0 * t), -1.5 * std::cos(4.0 * t), -kG * (1.0 + 0.15 * std::sin(6.0 * t))};
  }
  /// Greatest difference of quaternion components over a second of the wild motion.
  double distance_to(ReferenceFilter& reference) {
    double worst = 0.0;
    for (int k = 1; k <= 400; ++k) {
      const double t = k * kFilterDt;
      const Vector3 f = wild_force(t);
      const Vector3 w = wild_rate(t);
      step(f, w);
      reference.step(f, w, static_cast<double>(now_us) * 1e-6);
      worst = std::max(worst, (reference.q().coeffs() - quaternion().coeffs()).cwiseAbs().maxCoeff());
    }
    return worst;
  }
  Quaternion quaternion() const {
    const AttitudeQ& q = filter.attitude().q_NB;
    return {q.w, q.x, q.y, q.z};
  }

  ParameterStore parameters;
  AttitudeFilter filter;
  std::uint64_t now_us = 0;
};

TEST_F(AttitudeFilterTest, AgreesWithADoublePrecisionFilterThroughAWildSecond) {
  ReferenceFilter reference(Settings{});
  EXPECT_LT(distance_to(reference), kSinglePrecision);
  EXPECT_NEAR(filter.bias().x, reference.bias().x(), kSinglePrecision);
  EXPECT_NEAR(filter.bias().y, reference.bias().y(), kSinglePrecision);
  EXPECT_NEAR(filter.attitude().w_NB_B.z, reference.rate().z(), kSinglePrecision);
}

TEST_F(AttitudeFilterTest, DiffersMeasurablyFromAnUpdateThatUsesOldValuesThroughout) {
  Settings simultaneous;
  simultaneous.sequential = false;
  ReferenceFilter reference(simultaneous);
  EXPECT_GT(distance_to(reference), 20.0 * kSinglePrecision);
}

TEST_F(AttitudeFilterTest, AgreesWithNormalGainsWithoutSmoothingAndWithEulerSteps) {
  parameters.set(parameter("FILT_INIT_T"), 0);
  parameters.set(parameter("FILT_QUAD_INT"), 0);
  parameters.set(parameter("FILT_MAT_EXP"), 0);
  restart();
  Settings settings;
  settings.init_s = 0.0;
  settings.quadratic = false;
  settings.closed_form = false;
  ReferenceFilter reference(settings);
  EXPECT_LT(distance_to(reference), kSinglePrecision);
}

TEST_F(AttitudeFilterTest, LowPassesEachSensorWithItsOwnConstant) {
  parameters.set(parameter("ACC_LPF"), 0.6F);
  parameters.set(parameter("GYRO_XY_LPF"), 0.2F);
  parameters.set(parameter("GYRO_Z_LPF"), 0.7F);
  parameters.set(parameter("FILT_ACC_KP"), 0.3F);
  parameters.set(parameter("FILT_KI"), 0.05F);
  restart();
  Settings settings;
  settings.acc_lpf = 0.6;
  settings.gyro_xy_lpf = 0.2;
  settings.gyro_z_lpf = 0.7;
  settings.acc_kp = 0.3;
  settings.ki = 0.05;
  ReferenceFilter reference(settings);
  EXPECT_LT(distance_to(reference), kSinglePrecision);
}

TEST_F(AttitudeFilterTest, StaysLevelAtRest) {
  for (int k = 0; k < 400; ++k) step({0, 0, -kG}, Vector3::Zero());
  EXPECT_EQ(filter.attitude().q_NB.w, 1.0F);
  EXPECT_EQ(filter.attitude().roll(), 0.0F);
  EXPECT_EQ(filter.attitude().pitch(), 0.0F);
}

TEST_F(AttitudeFilterTest, TakesTwoSamplesToStart) {
  filter = AttitudeFilter();
  filter.configure(parameters);
  filter.reset();
  step({0, 0, -kG}, {1.0, 0.0, 0.0});
  EXPECT_EQ(filter.attitude().w_NB_B.x, 0.0F);
  step({0, 0, -kG}, {1.0, 0.0, 0.0});
  EXPECT_FLOAT_EQ(filter.attitude().w_NB_B.x, 0.7F);  // 1 - GYRO_XY_LPF
}

TEST_F(AttitudeFilterTest, TurnsHeadingByTheIntegralOfTheGyroAlone) {
  for (int k = 0; k < 400; ++k) step({0, 0, -kG}, {0.0, 0.0, 0.5});
  // The low pass and the smoothing start from rest: 0.3/0.7 and 0.5 steps behind.
  constexpr double kLagSteps = 0.3 / 0.7 + 0.5;
  EXPECT_NEAR(filter.attitude().heading(), 0.5 * kFilterDt * (400.0 - kLagSteps), 1e-4);
}

TEST_F(AttitudeFilterTest, LeansTowardsTheAccelerometer) {
  const double roll = 0.2;
  const Vector3 f(0.0, -kG * std::sin(roll), -kG * std::cos(roll));
  for (int k = 0; k < 1200; ++k) step(f, Vector3::Zero());
  EXPECT_NEAR(filter.attitude().roll(), roll, 0.02);  // 3 s at ten times the gain 0.5
  EXPECT_NEAR(filter.attitude().pitch(), 0.0, 1e-5);
}

TEST_F(AttitudeFilterTest, IgnoresAnAccelerometerOutsideItsMargin) {
  parameters.set(parameter("ACC_LPF"), 0.0F);
  restart();
  const auto tilted = [](double norm) { return Vector3(0.0, -norm * std::sin(0.2), -norm * std::cos(0.2)); };
  step(tilted(1.101 * kG), Vector3::Zero());
  step(tilted(0.899 * kG), Vector3::Zero());
  EXPECT_EQ(filter.attitude().roll(), 0.0F);
  step(tilted(1.099 * kG), Vector3::Zero());
  EXPECT_GT(filter.attitude().roll(), 0.0F);
}

TEST_F(AttitudeFilterTest, UsesTenfoldGainsBeforeTheInitialTimeEnds) {
  parameters.set(parameter("FILT_INIT_T"), 10);
  restart();
  const Vector3 f(0.0, -kG * std::sin(0.1), -kG * std::cos(0.1));
  step(f, Vector3::Zero());  // at 5 ms
  const double early = filter.attitude().roll();
  restart();
  now_us = 7500;
  step(f, Vector3::Zero());  // at 10 ms: no longer before
  EXPECT_NEAR(early / filter.attitude().roll(), 10.0, 0.01);
}

TEST_F(AttitudeFilterTest, BecomesUnhealthyAfterHalfASecondWithoutAnAccelerometer) {
  for (int k = 0; k < 200; ++k) step(Vector3::Zero(), Vector3::Zero());
  EXPECT_FALSE(filter.unhealthy()) << "500 ms are not yet more than 500 ms";
  step(Vector3::Zero(), Vector3::Zero());
  EXPECT_TRUE(filter.unhealthy());
  for (int k = 0; k < 20; ++k) step({0, 0, -kG}, Vector3::Zero());
  EXPECT_FALSE(filter.unhealthy());
}

TEST_F(AttitudeFilterTest, DoesNotWatchItsHealthWithoutAccelerometerOrOnAWing) {
  for (const ParameterId id : {parameter("FILT_USE_ACC"), parameter("FIXED_WING")}) {
    parameters.set_defaults();
    parameters.set(id, id == parameter("FIXED_WING") ? 1 : 0);
    restart();
    for (int k = 0; k < 400; ++k) step(Vector3::Zero(), Vector3::Zero());
    EXPECT_FALSE(filter.unhealthy());
  }
}

TEST_F(AttitudeFilterTest, FollowsAnExternalAttitudeInHeadingToo) {
  parameters.set(parameter("FILT_INIT_T"), 0);
  restart();
  const double heading = 0.3;
  const AttitudeQ turned = {static_cast<float>(std::cos(heading / 2)), 0, 0,
                            static_cast<float>(std::sin(heading / 2))};
  // First correction by hand: X and Y rows each contribute sin(0.3) about z, one step after the start.
  filter.set_external(turned);
  step({0, 0, -kG}, Vector3::Zero());
  EXPECT_NEAR(filter.attitude().heading(), 1.5 * 2.0 * std::sin(heading) * kFilterDt, 2e-5);
  for (int k = 0; k < 2000; ++k) {
    filter.set_external(turned);
    step({0, 0, -kG}, Vector3::Zero());
  }
  EXPECT_NEAR(filter.attitude().heading(), heading, 1e-3);
}

TEST_F(AttitudeFilterTest, WeighsAnExternalAttitudeByTheTimeSinceTheLast) {
  parameters.set(parameter("FILT_INIT_T"), 0);
  restart();
  for (int k = 0; k < 9; ++k) step({0, 0, -kG}, Vector3::Zero());
  filter.set_external({static_cast<float>(std::cos(0.05)), 0, 0, static_cast<float>(std::sin(0.05))});
  step({0, 0, -kG}, Vector3::Zero());  // ten steps after the start
  EXPECT_NEAR(filter.attitude().heading(), 10.0 * 1.5 * 2.0 * std::sin(0.1) * kFilterDt, 2e-5);
  const float once = filter.attitude().heading();
  step({0, 0, -kG}, Vector3::Zero());
  EXPECT_NEAR(filter.attitude().heading(), once, 2e-5) << "it acts in one step only";
}

TEST_F(AttitudeFilterTest, TakesTenfoldAccelerometerGainsForAnExternalAttitudeToo) {
  parameters.set(parameter("FILT_ACC_KP"), 0.4F);
  parameters.set(parameter("FILT_KI"), 0.02F);
  restart();
  filter.set_external({static_cast<float>(std::cos(0.15)), 0, 0, static_cast<float>(std::sin(0.15))});
  step({0, 0, -kG}, Vector3::Zero());
  const double error = 2.0 * std::sin(0.3);  // X and Y rows; positive: the estimate must turn on
  EXPECT_NEAR(filter.bias().z, -10.0 * 0.02 * error * kFilterDt, 1e-7);
  EXPECT_NEAR(filter.attitude().heading(),
              (10.0 * 0.4 * error - static_cast<double>(filter.bias().z)) * kFilterDt, 1e-6);
}

TEST_F(AttitudeFilterTest, FollowsAnExternalRollAndPitch) {
  parameters.set(parameter("FILT_INIT_T"), 0);
  parameters.set(parameter("FILT_KI"), 0.0F);
  restart();
  const Quaternion outside =
      Eigen::AngleAxisd(-0.1, Vector3::UnitY()) * Eigen::AngleAxisd(0.2, Vector3::UnitX());
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Quaternionf q = outside.cast<float>();
    filter.set_external({q.w(), q.x(), q.y(), q.z()});
    step({0, 0, -kG}, Vector3::Zero());
  }
  EXPECT_NEAR(filter.attitude().roll(), 0.2, 1e-3);
  EXPECT_NEAR(filter.attitude().pitch(), -0.1, 1e-3);
  EXPECT_NEAR(filter.attitude().heading(), 0.0, 1e-3);
}

TEST_F(AttitudeFilterTest, SurvivesAndCountsAnAccelerometerExactlyUpsideDown) {
  parameters.set(parameter("ACC_LPF"), 0.0F);
  restart();
  step({0, 0, kG}, {0.1, 0.0, 0.0});
  EXPECT_EQ(filter.undefined_tilts(), 1);
  EXPECT_TRUE(std::isfinite(filter.attitude().q_NB.w));
}

TEST_F(AttitudeFilterTest, ReproducesTheDivisionByZeroOnRequest) {
  parameters.set(parameter("ACC_LPF"), 0.0F);
  filter = AttitudeFilter(true);
  filter.configure(parameters);
  filter.reset();
  step({0, 0, -kG}, Vector3::Zero());
  step({0, 0, kG}, Vector3::Zero());
  EXPECT_TRUE(std::isnan(filter.attitude().q_NB.w));
  for (int k = 0; k < 400; ++k) step({0, 0, -kG}, Vector3::Zero());
  EXPECT_TRUE(std::isnan(filter.attitude().q_NB.w)) << "for ever";
  EXPECT_FALSE(filter.unhealthy()) << "and without any error bit";
  filter.reset();
  for (int k = 0; k < 3; ++k) step({0, 0, -kG}, Vector3::Zero());
  EXPECT_EQ(filter.attitude().q_NB.w, 1.0F) << "until a reset";
}

TEST_F(AttitudeFilterTest, KnowsThePitchOfAVerticalNose) {
  parameters.set(parameter("FILT_USE_ACC"), 0);
  double steepest = 0.0;
  for (int run = 0; run < 200; ++run) {
    restart();
    const double rate = 2.0 + 0.01 * run;
    for (int k = 0; k < 400; ++k) {
      step({0, 0, -kG}, {0.0, rate, 0.0});
      ASSERT_TRUE(std::isfinite(filter.attitude().pitch())) << "at " << rate << " rad/s, step " << k;
      steepest = std::max(steepest, static_cast<double>(filter.attitude().pitch()));
    }
  }
  EXPECT_NEAR(steepest, std::numbers::pi / 2.0, 1e-3);  // the arc sine knows a float32 that well near one
}

TEST_F(AttitudeFilterTest, KeepsTheScalarPartPositiveThroughAFullTurn) {
  const double rate = 2.0 * std::numbers::pi;  // one turn in a second
  for (int k = 0; k < 400; ++k) {
    step({0, 0, -kG}, {0.0, 0.0, rate});
    ASSERT_GE(filter.attitude().q_NB.w, 0.0F);
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
