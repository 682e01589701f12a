#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "hil_bridge/virtual_fcu/canned_mixers.hpp"
#include "hil_bridge/virtual_fcu/command.hpp"

// The matrices that the firmware brings along, number by number, and their inversion.

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr float kCannedSvd = 1e-5F;  // float32 singular-value decomposition of a 10 x 10 matrix

/// One mixer before its inversion: motors from pin 0 on, yaw alternating from +1.
struct Table {
  int id;
  float force;
  std::vector<float> roll;
  std::vector<float> pitch;
};

const float kS = .7071F;
const std::vector<Table> kTables = {
    {1, -.25F, {0, -1, 0, 1}, {1, 0, -1, 0}},
    {2, -.25F, {-kS, -kS, kS, kS}, {kS, -kS, -kS, kS}},
    {3, -.1667F, {0, -.866F, -.866F, 0, .866F, .866F}, {1, .5F, -.5F, -1, -.5F, .5F}},
    {4, -.1667F, {-.5F, -1, -.5F, .5F, 1, .5F}, {.866F, 0, -.866F, -.866F, 0, .866F}},
    {5, -.125F, {0, -kS, -1, -kS, 0, kS, 1, kS}, {1, kS, 0, -kS, -1, -kS, 0, kS}},
    {6,
     -.125F,
     {-.3827F, -.9239F, -.9239F, -.3827F, .3827F, .9239F, .9239F, .3827F},
     {.9239F, .3827F, -.3827F, -.9239F, -.9239F, -.3827F, .3827F, .9239F}},
    {7, -.1667F, {-.866F, -.866F, 0, 0, .866F, .866F}, {.5F, .5F, -1, -1, .5F, .5F}},
    {8, -.125F, {-kS, -kS, -kS, -kS, kS, kS, kS, kS}, {kS, kS, -kS, -kS, -kS, -kS, kS, kS}},
};

/// Compares every one of the hundred elements.
void expect_matrix(const CannedMixer& canned, const MixerMatrix& expected) {
  for (std::size_t i = 0; i < 10; ++i) {
    for (std::size_t j = 0; j < 10; ++j) {
      EXPECT_EQ(canned.matrix[i][j], expected[i][j]) << canned.name << " input " << i << " output " << j;
    }
  }
}

TEST(CannedMixerTableTest, HoldsTheNumbersOfEveryMultirotor) {
  for (const Table& table : kTables) {
    const CannedMixer canned = canned_mixer(table.id);
    MixerMatrix expected{};
    for (std::size_t j = 0; j < table.roll.size(); ++j) {
      expected[2][j] = table.force;
      expected[3][j] = table.roll[j];
      expected[4][j] = table.pitch[j];
      expected[5][j] = j % 2 == 0 ? 1.0F : -1.0F;
    }
    expect_matrix(canned, expected);
    for (std::size_t j = 0; j < 10; ++j) {
      const bool motor = j < table.roll.size();
      EXPECT_EQ(canned.kinds[j], motor ? OutputKind::kMotor : OutputKind::kAuxiliary) << canned.name << j;
      EXPECT_EQ(canned.rates[j], motor ? 490.0F : 50.0F) << canned.name << j;
    }
  }
}

TEST(CannedMixerTableTest, HoldsTheNumbersOfTheEscCalibration) {
  const CannedMixer canned = canned_mixer(0);
  MixerMatrix expected{};
  expected[2].fill(0.1F);
  expect_matrix(canned, expected);
  for (std::size_t j = 0; j < 10; ++j) {
    EXPECT_EQ(canned.kinds[j], OutputKind::kMotor);
    EXPECT_EQ(canned.rates[j], 50.0F);
  }
}

TEST(CannedMixerTableTest, HoldsTheNumbersOfBothWings) {
  MixerMatrix fixed_wing{};
  fixed_wing[0][4] = fixed_wing[3][0] = fixed_wing[4][1] = fixed_wing[5][2] = 1.0F;
  expect_matrix(canned_mixer(9), fixed_wing);
  MixerMatrix v_tail{};
  v_tail[0][4] = v_tail[3][0] = 1.0F;
  v_tail[4][1] = -0.5F;
  v_tail[4][2] = v_tail[5][1] = v_tail[5][2] = 0.5F;
  expect_matrix(canned_mixer(10), v_tail);
  constexpr OutputKind kServo = OutputKind::kServo;
  constexpr OutputKind kNone = OutputKind::kAuxiliary;
  const std::array<OutputKind, 10> kinds = {kServo, kServo, kServo, kNone, OutputKind::kMotor,
                                            kNone,  kNone,  kNone,  kNone, kNone};
  for (const int id : {9, 10}) {
    EXPECT_EQ(canned_mixer(id).kinds, kinds);
    for (const float rate : canned_mixer(id).rates) EXPECT_EQ(rate, 50.0F);
  }
}

class CannedMixerTest : public ::testing::TestWithParam<int> {};

TEST_P(CannedMixerTest, IsAPseudoInverse) {
  const CannedMixer canned = canned_mixer(GetParam());
  const MixerMatrix inverse = inverted(canned.matrix);
  Eigen::Matrix<double, 10, 10> a;
  Eigen::Matrix<double, 10, 10> p;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      a(i, j) = static_cast<double>(canned.matrix[i][j]);
      p(j, i) = static_cast<double>(inverse[i][j]);
    }
  }
  // The four conditions of Moore and Penrose.
  EXPECT_LT((a * p * a - a).cwiseAbs().maxCoeff(), kCannedSvd);
  EXPECT_LT((p * a * p - p).cwiseAbs().maxCoeff(), 2.0 * kCannedSvd);
  EXPECT_LT((a * p - (a * p).transpose()).cwiseAbs().maxCoeff(), kCannedSvd);
  EXPECT_LT((p * a - (p * a).transpose()).cwiseAbs().maxCoeff(), kCannedSvd);
}

INSTANTIATE_TEST_SUITE_P(All, CannedMixerTest, ::testing::Range(0, 11));

TEST(CannedMixerInversionTest, ClearsWhatIsOnlyRoundOff) {
  for (int id = 0; id < 11; ++id) {
    for (const auto& row : inverted(canned_mixer(id).matrix)) {
      for (const float element : row) EXPECT_TRUE(element == 0.0F || std::fabs(element) >= 1e-6F) << element;
    }
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
