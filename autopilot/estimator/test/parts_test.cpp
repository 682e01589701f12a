#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "autopilot/estimator/alignment.hpp"
#include "autopilot/estimator/delay_line.hpp"
#include "autopilot/estimator/fix_trust.hpp"
#include "autopilot/estimator/gate.hpp"
#include "autopilot/estimator/scalar_update.hpp"
#include "autopilot/estimator/vibration_watch.hpp"
#include "autopilot/math/euler_zyx.hpp"

namespace ironbird::autopilot {
namespace {

using std::chrono::milliseconds;

constexpr double kRoundOff = 1.0e-12;

TEST(ScalarUpdateTest, EqualsTheJointUpdateInJosephForm) {
  constexpr int kSize = 6;
  using Matrix6 = Eigen::Matrix<double, kSize, kSize>;
  using Vector6 = Eigen::Matrix<double, kSize, 1>;
  Matrix6 root;
  Eigen::Matrix<double, 3, kSize> C;
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) root(i, j) = std::sin(1.7 * i + 0.9 * j * j + 0.3);
    for (int k = 0; k < 3; ++k) C(k, i) = std::cos(2.1 * i - 0.8 * k);
  }
  const Matrix6 P = root * root.transpose();
  const Vector3 innovation(0.3, -0.2, 0.5);
  const Vector3 R(0.4, 0.1, 0.7);

  const Matrix3 S = C * P * C.transpose() + Matrix3(R.asDiagonal());
  const Eigen::Matrix<double, kSize, 3> K = P * C.transpose() * S.inverse();
  const Matrix6 left = Matrix6::Identity() - K * C;
  const Matrix6 joint = left * P * left.transpose() + K * R.asDiagonal() * K.transpose();

  Matrix6 sequential = P;
  ScalarUpdate<kSize> update;
  for (int row = 0; row < 3; ++row)
    update.fuse_block<kSize>(sequential, innovation(row), C.row(row), 0, R(row));
  EXPECT_LT((sequential - joint).norm(), 1.0e-10) << "P of order 10, condition of S of order 100";
  EXPECT_LT((update.correction - Vector6(K * innovation)).norm(), 1.0e-10);
  EXPECT_EQ((sequential - sequential.transpose()).cwiseAbs().maxCoeff(), 0.0);
}

TEST(FixTrustTest, BlamesTheReceiverUnlessTheFilterMayHaveDriftedSoFar) {
  constexpr double kSilence = 1.0;  // s
  constexpr double kWorst = 3.0;    // m/s
  FixTrust trust;
  trust.begin(milliseconds(0));
  for (int ms = 100; ms <= 5000; ms += 100) trust.velocity_believed(milliseconds(ms), kWorst, kSilence);
  EXPECT_TRUE(trust.blames_receiver(2.0, kWorst, milliseconds(5100), kSilence)) << "measured throughout";
  // A pause of four seconds may have cost twelve metres, until a position is believed again.
  trust.velocity_believed(milliseconds(9000), kWorst, kSilence);
  EXPECT_FALSE(trust.blames_receiver(11.9, kWorst, milliseconds(9100), kSilence));
  EXPECT_TRUE(trust.blames_receiver(12.1, kWorst, milliseconds(9100), kSilence));
  trust.position_believed(milliseconds(9200));
  EXPECT_TRUE(trust.blames_receiver(2.0, kWorst, milliseconds(9300), kSilence));
  EXPECT_FALSE(trust.blames_receiver(5.9, kWorst, milliseconds(11200), kSilence)) << "the pause goes on";
}

TEST(VibrationWatchTest, FeelsWhatIsFastAndNotWhatIsSlow) {
  constexpr double kStep = 0.0025;  // s
  VibrationWatch shaken;
  VibrationWatch flown;
  for (int k = 0; k < 4000; ++k) {
    const double t = k * kStep;
    shaken.add({0.0, 0.0, -9.81 + 3.0 * std::sin(2.0 * std::numbers::pi * 60.0 * t)}, kStep);
    flown.add({3.0 * std::sin(2.0 * std::numbers::pi * 0.1 * t), 0.0, -9.81}, kStep);
  }
  EXPECT_NEAR(shaken.rms(), 3.0 / std::sqrt(2.0), 0.1);
  EXPECT_LT(flown.rms(), 0.25);
}

TEST(GateTest, AcceptsRejectsAndFinallyResets) {
  Gate gate;
  EXPECT_EQ(gate.judge(1.0, 9.0, 2.0, milliseconds(0)), Verdict::kAccept);
  EXPECT_EQ(gate.judge(10.0, 9.0, 2.0, milliseconds(1000)), Verdict::kReject);
  EXPECT_EQ(gate.judge(10.0, 9.0, 2.0, milliseconds(2900)), Verdict::kReject);
  EXPECT_EQ(gate.judge(10.0, 9.0, 2.0, milliseconds(3000)), Verdict::kReset);
  EXPECT_EQ(gate.judge(1.0, 9.0, 2.0, milliseconds(3100)), Verdict::kAccept);
  EXPECT_EQ(gate.judge(1.0e9, 0.0, 2.0, milliseconds(3200)), Verdict::kAccept) << "threshold 0: no gate";
}

TEST(GateTest, BeginsToCountAnewAfterOneAgreement) {
  Gate gate;
  gate.judge(10.0, 9.0, 2.0, milliseconds(0));
  gate.judge(1.0, 9.0, 2.0, milliseconds(1500));
  EXPECT_EQ(gate.judge(10.0, 9.0, 2.0, milliseconds(2500)), Verdict::kReject);
}

TEST(GateTest, DoesNotTakeTwoFaultsFarApartForADisagreement) {
  Gate gate;
  EXPECT_EQ(gate.judge(10.0, 9.0, 3.0, milliseconds(0)), Verdict::kReject);
  EXPECT_EQ(gate.judge(10.0, 9.0, 3.0, milliseconds(5000)), Verdict::kReject) << "two are too few";
  EXPECT_EQ(gate.judge(10.0, 9.0, 3.0, milliseconds(15000)), Verdict::kReject) << "too long ago";
  EXPECT_EQ(gate.judge(10.0, 9.0, 3.0, milliseconds(16000)), Verdict::kReject);
  EXPECT_EQ(gate.judge(10.0, 9.0, 3.0, milliseconds(18000)), Verdict::kReset);
}

TEST(GateTest, TellsHowFarAMeasurementMayBeOff) {
  constexpr double kVariance = 4.0, kThreshold = 9.0;
  const double reach = Gate::reach(kVariance, kThreshold);
  EXPECT_EQ(reach, 6.0);
  Gate gate;
  EXPECT_EQ(gate.judge(reach * reach / kVariance, kThreshold, 1.0, Time{0}), Verdict::kAccept);
  EXPECT_EQ(gate.judge(1.01 * reach * reach / kVariance, kThreshold, 1.0, Time{0}), Verdict::kReject);
  EXPECT_EQ(Gate::reach(kVariance, 0.0), 0.0) << "no gate";
}

TEST(GateTest, RejectsWhatIsNoNumber) {
  Gate gate;
  EXPECT_EQ(gate.judge(std::nan(""), 9.0, 2.0, milliseconds(0)), Verdict::kReject);
}

TEST(DelayLineTest, InterpolatesBetweenItsEntries) {
  DelayLine line;
  line.push(milliseconds(10), {1.0, 0.0, 0.0}, {0.0, 2.0, 0.0});
  line.push(milliseconds(20), {2.0, 0.0, 0.0}, {0.0, 4.0, 0.0});
  const auto past = line.at(milliseconds(15));
  ASSERT_TRUE(past.has_value());
  EXPECT_NEAR(past->p_N.x(), 1.5, kRoundOff);
  EXPECT_NEAR(past->v_N.y(), 3.0, kRoundOff);
  EXPECT_FALSE(line.at(milliseconds(9)).has_value());
  EXPECT_EQ(line.at(milliseconds(30))->p_N.x(), 2.0);
}

TEST(DelayLineTest, AppliesLaterCorrectionsToThePastOnly) {
  DelayLine line;
  line.push(milliseconds(10), Vector3::Zero(), Vector3::Zero());
  line.correct({5.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  line.push(milliseconds(20), {5.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  EXPECT_EQ(line.at(milliseconds(10))->p_N.x(), 5.0);
  EXPECT_EQ(line.at(milliseconds(20))->p_N.x(), 5.0);
}

TEST(DelayLineTest, ForgetsTheOldest) {
  DelayLine line;
  for (int i = 0; i <= DelayLine::kCapacity; ++i)
    line.push(milliseconds(4 * i), {1.0 * i, 0.0, 0.0}, Vector3::Zero());
  EXPECT_FALSE(line.at(milliseconds(0)).has_value());
  EXPECT_NEAR(line.at(milliseconds(4))->p_N.x(), 1.0, kRoundOff);
}

TEST(OutlierTest, IsTheMeanOfAnyNumberOfGoodValues) {
  std::array<double, 512> values{};
  values[0] = 90000.0;
  EXPECT_EQ(mean_without_outliers(values, 1), 90000.0);
  for (const int count : {2, 3, 7, 100, 101, 512}) {
    for (int i = 0; i < count; ++i) values[i] = 90000.0 + (i % 2 == 0 ? 1.0 : -1.0);
    const double expected = 90000.0 + (count % 2 == 0 ? 0.0 : 1.0 / count);
    EXPECT_NEAR(mean_without_outliers(values, count), expected, 1.0e-9) << count;
  }
}

TEST(OutlierTest, LeavesOutliersOut) {
  std::array<double, 512> values{};
  for (int i = 0; i < 50; ++i) values[i] = 90000.0 + 0.1 * i;
  values[17] = 50000.0;
  values[33] = 120000.0;
  EXPECT_NEAR(mean_without_outliers(values, 50), 90002.45, 0.1);
}

struct AttitudeCase {
  const char* name;
  Vector3 theta;
  Vector3 a_N;
};

class AttitudeFromVectorsCaseTest : public ::testing::TestWithParam<AttitudeCase> {};

TEST_P(AttitudeFromVectorsCaseTest, FindsTheAttitudeThatMadeTheReadings) {
  constexpr double kGravity = 9.81;
  constexpr double kDeclination = 0.2;
  const Matrix3 R_NB = rotation_NB(EulerTrig(GetParam().theta));
  const Vector3 field_N(0.4 * std::cos(kDeclination), 0.4 * std::sin(kDeclination), 0.9);
  const Vector3 f_B = R_NB.transpose() * (GetParam().a_N - kGravity * Vector3::UnitZ());
  const Quaternion q_NB =
      attitude_from_vectors(f_B, GetParam().a_N, R_NB.transpose() * field_N, kDeclination, kGravity).q_NB;
  EXPECT_LT((q_NB.toRotationMatrix() - R_NB).norm(), 1.0e-9);
}

INSTANTIATE_TEST_SUITE_P(Attitudes, AttitudeFromVectorsCaseTest,
                         ::testing::Values(AttitudeCase{"Level", {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}},
                                           AttitudeCase{"Tilted", {0.2, -0.3, 2.5}, {0.0, 0.0, 0.0}},
                                           AttitudeCase{"South", {0.0, 0.1, 3.14159}, {0.0, 0.0, 0.0}},
                                           AttitudeCase{"Accelerating", {0.3, 0.2, -1.0}, {2.0, -1.5, 0.5}},
                                           AttitudeCase{"Inverted", {3.0, 0.1, 0.4}, {0.0, 0.0, 0.0}},
                                           AttitudeCase{
                                               "UpsideDown", {std::numbers::pi, 0.0, 0.4}, {0.0, 0.0, 0.0}}),
                         [](const auto& case_) { return std::string(case_.param.name); });

TEST(AttitudeFromVectorsTest, SaysWhenTheFieldLeavesTheHeadingOpen) {
  // The field of 48 degrees north dips by 73 degrees: less than a lean of 17 degrees is between it and down.
  const Vector3 field_N(std::cos(1.274), 0.0, std::sin(1.274));
  const auto ambiguity = [&](const Vector3& a_N) {
    return attitude_from_vectors(a_N - 9.81 * Vector3::UnitZ(), a_N, field_N, 0.0, 9.81).ambiguity;
  };
  EXPECT_LT(ambiguity(Vector3::Zero()), kRoundOff);
  EXPECT_LT(ambiguity({4.0, 0.0, 0.0}), kRoundOff) << "leaning away from the field";
  EXPECT_GT(ambiguity({-4.0, 0.0, 0.0}), 0.5) << "towards it and beyond: both headings have it to the north";
  EXPECT_LT(ambiguity({0.0, 1.0, 0.0}), 0.5);
  EXPECT_GT(ambiguity({0.0, 2.0, 0.0}), 0.5);
  EXPECT_GT(ambiguity({0.0, 4.0, 0.0}), 0.7);
  EXPECT_LT(ambiguity({4.0, 0.0, 0.0}), kRoundOff) << "leaning away from the field";
  EXPECT_GT(ambiguity({-4.0, 0.0, 0.0}), 0.5) << "towards it and beyond: both headings have it to the north";
}

TEST(AlignmentTest, TakesInMotionTheForcesOfTheTimeThatTheFixesTellOf) {
  // GIVEN a level vehicle that speeds up for half a second, and then goes on; and fixes from then on
  AidingParams params;
  params.alignment.fixes = 2;
  params.alignment.baro_samples = 1;
  Alignment alignment;
  alignment.restart_in_motion();
  bool found = false;
  int k = 0;
  // WHEN the filter starts
  for (; k < 300 && !found; ++k) {
    const bool speeds_up = k < 50;
    SensorFrame frame;
    frame.imu.stamp = milliseconds(10 * k);
    frame.imu.f_B = Vector3(speeds_up ? 4.0 : 0.0, 0.0, -params.gravity);
    frame.mag = MagSample{frame.imu.stamp, Vector3(0.4, 0.0, 0.9)};
    frame.baro = BaroSample{frame.imu.stamp, 100000.0, 288.15};
    if (!speeds_up && k % 20 == 0) {
      GnssSample fix;
      fix.stamp = frame.imu.stamp;
      fix.v_NB_N = Vector3(2.0, 0.0, 0.0);
      fix.fix = GnssFix::kFix3D;
      frame.gnss = fix;
    }
    found = alignment.add(frame, 0.01, params);
  }
  // THEN it is level, and the fixes tell of half a second at least
  ASSERT_TRUE(found);
  EXPECT_LT(euler_from_quaternion(alignment.start().q_NB).norm(), kRoundOff);
  EXPECT_EQ(k, 121) << "fixes at 0.6, 0.8, 1.0 and 1.2 s";
}

}  // namespace
}  // namespace ironbird::autopilot
