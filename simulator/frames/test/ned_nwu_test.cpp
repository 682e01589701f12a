#include "simulator/frames/ned_nwu.hpp"

#include <gtest/gtest.h>

namespace ironbird::simulator {
namespace {

constexpr double kRounding = 1e-15;

TEST(NedNwuTest, TurnsHalfAboutTheFirstAxis) {
  EXPECT_EQ(ned_nwu(Vector3(1.0, 2.0, 3.0)), Vector3(1.0, -2.0, -3.0));
}

TEST(NedNwuTest, IsItsOwnInverseToTheBit) {
  const Vector3 v(0.1, -0.2, 0.3);
  const Quaternion q = Quaternion(0.3, -0.4, 0.5, 0.6).normalized();
  EXPECT_EQ(ned_nwu(ned_nwu(v)), v);
  EXPECT_EQ(ned_nwu(ned_nwu(q)).coeffs(), q.coeffs());
}

TEST(NedNwuTest, CommutesWithTurningAVector) {
  const Vector3 v_B(0.1, -0.2, 0.3);
  const Quaternion q_NB = Quaternion(0.3, -0.4, 0.5, 0.6).normalized();
  const Vector3 in_engine = ned_nwu(q_NB) * ned_nwu(v_B);
  EXPECT_LT((in_engine - ned_nwu(Vector3(q_NB * v_B))).norm(), kRounding);
}

TEST(NedNwuTest, CommutesWithMultiplyingQuaternions) {
  const Quaternion a = Quaternion(0.3, -0.4, 0.5, 0.6).normalized();
  const Quaternion b = Quaternion(0.1, 0.9, -0.2, 0.4).normalized();
  EXPECT_LT(((ned_nwu(a) * ned_nwu(b)).coeffs() - ned_nwu(a * b).coeffs()).norm(), kRounding);
}

}  // namespace
}  // namespace ironbird::simulator
