#include "autopilot/math/euler_zyx.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoundOff = 1.0e-12;       // a few dozen operations on numbers of order 1
constexpr double kDifferenceStep = 1.0e-5;  // truncation 1e-10 of the third derivative
constexpr double kDifferenceTolerance = 1.0e-7;

struct AngleCase {
  const char* name;
  double roll, pitch, heading;
};

class EulerZyxTest : public ::testing::TestWithParam<AngleCase> {
 protected:
  Vector3 theta() const { return {GetParam().roll, GetParam().pitch, GetParam().heading}; }

  /// Column by column, of a vector function of the angles; relative to the size of the derivative.
  template <class Function>
  void expect_derivative(const Matrix3& analytic, Function&& function) const {
    for (int column = 0; column < 3; ++column) {
      const Vector3 step = kDifferenceStep * Vector3::Unit(column);
      const Vector3 numeric = (function(theta() + step) - function(theta() - step)) / (2.0 * kDifferenceStep);
      const double scale = 1.0 + analytic.cwiseAbs().maxCoeff() * analytic.cwiseAbs().maxCoeff();
      EXPECT_LT((numeric - analytic.col(column)).norm(), kDifferenceTolerance * scale) << "column " << column;
    }
  }
};

TEST_P(EulerZyxTest, EqualsTheProductOfThreeRotations) {
  const Matrix3 expected =
      (Eigen::AngleAxisd(theta().z(), Vector3::UnitZ()) * Eigen::AngleAxisd(theta().y(), Vector3::UnitY()) *
       Eigen::AngleAxisd(theta().x(), Vector3::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((rotation_NB(EulerTrig(theta())) - expected).norm(), kRoundOff);
  EXPECT_LT((quaternion_NB(theta()).toRotationMatrix() - expected).norm(), kRoundOff);
}

TEST_P(EulerZyxTest, ReturnsFromTheQuaternionToTheSameAttitude) {
  const Quaternion q_NB = quaternion_NB(theta());
  const Vector3 back = euler_from_quaternion(q_NB);
  constexpr double kPoleLoss = 1.0e-7;  // asin loses half the digits at its ends
  EXPECT_LT((quaternion_NB(back).toRotationMatrix() - q_NB.toRotationMatrix()).norm(), kPoleLoss);
  EXPECT_LE(std::abs(back.y()), 0.5 * kPi);
}

TEST_P(EulerZyxTest, KeepsTheAttitudeWhenMadeCanonical) {
  bool flipped = false;
  const Vector3 same = canonical_euler(theta(), flipped);
  EXPECT_LT((quaternion_NB(same).toRotationMatrix() - quaternion_NB(theta()).toRotationMatrix()).norm(),
            kRoundOff);
  EXPECT_LE(std::abs(same.y()), 0.5 * kPi + kRoundOff);
}

TEST_P(EulerZyxTest, TurnsBodyRatesIntoAngleRates) {
  const EulerTrig at(theta());
  if (std::abs(at.c_theta) * EulerTrig::kMaxSecant < 1.0) GTEST_SKIP() << "singular: S is bounded there";
  EXPECT_LT((euler_rate_matrix(at) * body_rate_matrix(at) - Matrix3::Identity()).norm(), 1.0e-9);
}

TEST_P(EulerZyxTest, HasTheDerivativeOfARotatedVector) {
  const Vector3 v_B(3.0, -2.0, 1.5);
  expect_derivative(rotated_vector_jacobian(EulerTrig(theta()), v_B),
                    [&](const Vector3& t) -> Vector3 { return rotation_NB(EulerTrig(t)) * v_B; });
}

TEST_P(EulerZyxTest, HasTheDerivativeOfDownInTheBody) {
  expect_derivative(down_in_body_jacobian(EulerTrig(theta())), [](const Vector3& t) -> Vector3 {
    return rotation_NB(EulerTrig(t)).transpose() * Vector3::UnitZ();
  });
}

TEST_P(EulerZyxTest, StaysFiniteEverywhere) {
  const EulerTrig at(theta());
  EXPECT_TRUE(euler_rate_matrix(at).allFinite());
  EXPECT_TRUE(euler_rate_jacobian(at, Vector3(1.0, 2.0, 3.0)).allFinite());
}

INSTANTIATE_TEST_SUITE_P(
    Angles, EulerZyxTest,
    ::testing::Values(AngleCase{"Level", 0.0, 0.0, 0.0}, AngleCase{"Ordinary", 0.3, -0.2, 1.1},
                      AngleCase{"Inverted", 3.0, 0.4, -2.9}, AngleCase{"Seam", kPi, 0.1, -kPi},
                      AngleCase{"NearlyUp", 0.5, 1.5, 2.0}, AngleCase{"NoseUp", 0.5, 0.5 * kPi, 2.0},
                      AngleCase{"NoseDown", -0.4, -0.5 * kPi, -1.0}, AngleCase{"Beyond", 0.2, 2.0, 0.3}),
    [](const auto& case_) { return std::string(case_.param.name); });

TEST(EulerRateTest, HasTheDerivativeAwayFromThePole) {
  const Vector3 w_B(0.4, -0.7, 1.2);
  for (const double pitch : {0.0, 0.7, -1.3, 1.5}) {
    const Vector3 theta(0.6, pitch, -1.0);
    const Matrix3 analytic = euler_rate_jacobian(EulerTrig(theta), w_B);
    for (int column = 0; column < 3; ++column) {
      const Vector3 step = kDifferenceStep * Vector3::Unit(column);
      const Vector3 numeric = (euler_rate_matrix(EulerTrig(theta + step)) * w_B -
                               euler_rate_matrix(EulerTrig(theta - step)) * w_B) /
                              (2.0 * kDifferenceStep);
      // The third derivative grows as 1/cos^4.
      const double scale = 1.0 + 1.0 / std::pow(std::cos(pitch), 4);
      EXPECT_LT((numeric - analytic.col(column)).norm(), kDifferenceTolerance * scale)
          << pitch << ' ' << column;
    }
  }
}

TEST(SkewTest, MakesTheCrossProduct) {
  const Vector3 a(1.0, 2.0, 3.0);
  const Vector3 b(-4.0, 5.0, 0.5);
  EXPECT_EQ(Vector3(skew(a) * b), a.cross(b));
}

}  // namespace
}  // namespace ironbird::autopilot
