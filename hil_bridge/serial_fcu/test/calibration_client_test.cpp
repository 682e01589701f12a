#include "hil_bridge/serial_fcu/calibration_client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "hil_bridge/serial_fcu/test/served_unit.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::DeskLink;
using testing::HasSubstr;

constexpr Time kPatience = seconds(90);

/// Orders a calibration from a unit that is known, and waits for its outcome.
class Order {
 public:
  Order(DeskLink& link, std::string_view name) : link_(link) {
    link.until(kPatience, [&] { return link.fcu().connection().state() == ConnectionState::kReady; });
    client_.emplace(*find_calibration(name), link.fcu().connection().parameters());
  }
  /// One tick. @return is it over?
  bool tick() {
    for (const Arrival& arrival : link_.inbox()) client_->take(arrival.message, link_.now());
    client_->advance(link_.now(), [&](const rosflight::Message& message) { link_.fcu().send(message); });
    return client_->over();
  }
  const CalibrationClient& wait() {
    took = link_.until(kPatience, [&] { return tick(); });
    return *client_;
  }
  float value(std::string_view name) const {
    return std::bit_cast<float>(link_.fcu().connection().parameters().find(name)->bits);
  }
  Time took{};

 private:
  DeskLink& link_;
  std::optional<CalibrationClient> client_;
};

VirtualFcuConfig quiet_unit() {
  VirtualFcuConfig config;
  config.calibrate_imu_at_start = false;
  return config;
}

class LossyCalibrationTest : public testing::TestWithParam<int> {};

TEST_P(LossyCalibrationTest, FindsTheBiasesOfTheImuOverALineThatLosesAFifth) {
  DeskLink link(0.2, static_cast<std::uint64_t>(GetParam()), {}, quiet_unit());
  link.unit().feel({0.1, -0.2, -9.9}, {0.01, 0.02, -0.03});
  Order order(link, "imu");
  const CalibrationClient& calibration = order.wait();
  EXPECT_EQ(calibration.state(), CalibrationState::kDone) << calibration.reason();
  EXPECT_NEAR(order.value("ACC_X_BIAS"), 0.1, 1e-3);
  EXPECT_EQ(calibration.changes()[1].name, "ACC_Y_BIAS");
  EXPECT_GE(order.took, milliseconds(2500));
}

TEST_P(LossyCalibrationTest, FindsTheBiasesOfTheGyroOverALineThatLosesHalf) {
  DeskLink link(0.5, static_cast<std::uint64_t>(GetParam()), {}, quiet_unit());
  link.unit().feel({0.0, 0.0, -9.80665}, {0.01, 0.02, -0.03});
  Order order(link, "gyro");
  const CalibrationClient& calibration = order.wait();
  EXPECT_EQ(calibration.state(), CalibrationState::kDone) << calibration.reason();
  EXPECT_NEAR(order.value("GYRO_Z_BIAS"), -0.03, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Seeds, LossyCalibrationTest, testing::Range(1, 11));

TEST(CalibrationClientTest, BelievesTheUnitThatIsDoneWhereTheResultIsZero) {
  DeskLink link(0.0, 1, {}, quiet_unit());
  Order order(link, "imu");
  EXPECT_EQ(order.wait().state(), CalibrationState::kDone);
}

TEST(CalibrationClientTest, FailsInTheUnitsWordsWhenTheVehicleMoves) {
  DeskLink link(0.0, 1, {}, quiet_unit());
  Order order(link, "imu");
  for (int k = 0; k < 2000 && !order.tick(); ++k) {
    link.unit().feel({0.0, 0.0, k % 100 < 50 ? -9.0 : -10.5}, simulator::Vector3::Zero());
    link.tick();
  }
  const CalibrationClient& calibration = order.wait();
  EXPECT_EQ(calibration.state(), CalibrationState::kFailed);
  EXPECT_EQ(calibration.reason(), "the unit says: IMU calibration: too much movement");
}

TEST(CalibrationClientTest, FailsWhenTheGyroTurnsAndSaysSo) {
  DeskLink link(0.0, 1, {}, quiet_unit());
  link.unit().feel({0.0, 0.0, -9.80665}, {1.5, 0.0, 0.0});
  Order order(link, "gyro");
  const CalibrationClient& calibration = order.wait();
  EXPECT_EQ(calibration.state(), CalibrationState::kFailed);
  EXPECT_THAT(calibration.reason(), HasSubstr("too much movement"));
}

TEST(CalibrationClientTest, FailsInTheEndWhenNoResultIsTold) {
  DeskLink link(0.0, 1, {},
                quiet_unit());  // without noise the gyro's biases are zeros, and no text tells of them
  Order order(link, "gyro");
  const CalibrationClient& calibration = order.wait();
  EXPECT_EQ(calibration.state(), CalibrationState::kFailed);
  EXPECT_EQ(calibration.reason(), "the unit told no result in time");
}

TEST(CalibrationClientTest, FindsThePressureOfTheGround) {
  DeskLink link(0.0, 1, {}, quiet_unit());
  link.unit().press(85'000.0);
  link.until(seconds(8), [] { return false; });  // the unit's own calibration at its start
  link.unit().press(86'000.0);
  Order order(link, "baro");
  EXPECT_EQ(order.wait().state(), CalibrationState::kDone);
  EXPECT_NEAR(order.value("BARO_BIAS"), 86'000.0F, 1.0F);
  EXPECT_GE(order.took, seconds(5)) << "the result of the unit's own calibration is not ours";
}

TEST(CalibrationClientTest, IsRefusedByAnArmedUnit) {
  VirtualFcuConfig config;
  config.parameters = {{"PRIMARY_MIXER", 2}, {"FAILSAFE_THR", 0.2}, {"RC_NUM_CHN", 8}, {"RC_ARM_CHN", 5}};
  DeskLink link(0.0, 1, {}, config);
  Order order(link, "imu");
  link.until(seconds(4), [] { return false; });
  link.unit().host().pilot().arm(true);
  link.until(seconds(1), [] { return false; });
  ASSERT_TRUE(link.firmware().arming().armed());
  const CalibrationClient& calibration = order.wait();
  EXPECT_EQ(calibration.state(), CalibrationState::kRefused);
  EXPECT_THAT(calibration.reason(), HasSubstr("armed"));
}

TEST(CalibrationClientTest, OrdersATrimOnlyOnceBecauseTrimsAddUp) {
  DeskLink link(0.0, 1, {}, quiet_unit());
  Order order(link, "rc-trim");
  link.pair().hang_up();
  const CalibrationClient calibration(*find_calibration("rc-trim"), link.fcu().connection().parameters());
  CalibrationClient asked = calibration;
  int orders = 0;
  for (Time now{}; now < seconds(10); now += milliseconds(20)) {
    asked.advance(now, [&](const rosflight::Message&) { ++orders; });
  }
  EXPECT_EQ(orders, 1);
  EXPECT_EQ(asked.state(), CalibrationState::kNoAnswer);
}

TEST(CalibrationClientTest, TakesTheTrimFromTheSticks) {
  VirtualFcuConfig config = quiet_unit();
  config.parameters = {{"PRIMARY_MIXER", 2}};
  DeskLink link(0.0, 1, {}, config);
  link.unit().host().pilot().set_stick(Stick::kRoll, 0.05);
  link.until(seconds(1), [] { return false; });
  Order order(link, "rc-trim");
  EXPECT_EQ(order.wait().state(), CalibrationState::kDone);
  EXPECT_NE(order.value("X_EQ_TORQUE"), 0.0F);
}

TEST(CalibrationClientTest, KnowsItsKindsByName) {
  for (const CalibrationKind& kind : calibration_kinds()) EXPECT_EQ(find_calibration(kind.name), &kind);
  EXPECT_EQ(find_calibration("compass"), nullptr);
}

}  // namespace
}  // namespace ironbird::hil_bridge
