#include "scenarios/requirements/signal_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "autopilot/signals.hpp"
#include "hil_bridge/rosflight/messages.hpp"
#include "scenarios/requirements/condition.hpp"
#include "scenarios/requirements/subject.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {
namespace {

constexpr double kSignalRoundOff = 1e-12;

class SignalTableTest : public ::testing::Test {
 protected:
  SignalTableTest() {
    table_.add("truth", truth_);
    table_.add("autopilot", signals_);
  }
  double value(const std::string& path) const { return table_.find(path).value(); }

  simulator::Truth truth_;
  autopilot::Signals signals_;
  SignalTable table_;
};

TEST_F(SignalTableTest, ReadsWhatStandsInTheStructNow) {
  const Signal east = table_.find("truth.p_NB_N.y");
  truth_.p_NB_N.y() = 4.5;
  EXPECT_EQ(east.value(), 4.5);
  truth_.p_NB_N.y() = -1.0;
  EXPECT_EQ(east.value(), -1.0);
  EXPECT_EQ(east.unit(), "m");
}

TEST_F(SignalTableTest, ReadsEveryKindOfNumber) {
  truth_.rotor_speed[3] = 700.0;
  truth_.in_contact = true;
  truth_.stamp = std::chrono::milliseconds(1500);
  truth_.q_NB = Eigen::Quaterniond(0.5, 0.1, 0.2, 0.3);
  signals_.trajectory.reached = 7;
  signals_.flight.phase = autopilot::FlightPhase::kLanding;
  signals_.route.waypoints.resize(3);
  EXPECT_EQ(value("truth.rotor_speed[3]"), 700.0);
  EXPECT_EQ(value("truth.in_contact"), 1.0);
  EXPECT_EQ(value("truth.stamp"), 1.5);
  EXPECT_EQ(table_.find("truth.stamp").unit(), "s");
  EXPECT_EQ(value("truth.q_NB.w"), 0.5);
  EXPECT_EQ(value("truth.q_NB.z"), 0.3);
  EXPECT_EQ(value("autopilot.trajectory.reached"), 7.0);
  EXPECT_EQ(value("autopilot.flight.phase"), 4.0);
  EXPECT_EQ(value("autopilot.route.waypoints.size"), 3.0);
}

TEST_F(SignalTableTest, ReadsAnAbsentOptionalAsNotANumber) {
  const Signal field = table_.find("autopilot.sensors.mag.m_B.x");
  const Signal fix = table_.find("autopilot.sensors.gnss.fix");
  EXPECT_FALSE(field.present());
  EXPECT_TRUE(std::isnan(field.value()));
  signals_.sensors.mag = autopilot::MagSample{.stamp = {}, .m_B = {0.3, 0.0, 0.0}};
  signals_.sensors.gnss = autopilot::GnssSample{.fix = autopilot::GnssFix::kRtkFixed};
  EXPECT_TRUE(field.present());
  EXPECT_EQ(field.value(), 0.3);
  EXPECT_EQ(fix.value(), 7.0);
  signals_.sensors.mag.reset();
  EXPECT_TRUE(std::isnan(field.value()));
}

TEST_F(SignalTableTest, ReadsAVariantByItsAlternative) {
  const Signal throttle = table_.find("autopilot.command.rate_command.throttle");
  const Signal kind = table_.find("autopilot.command");
  EXPECT_TRUE(std::isnan(throttle.value()));
  autopilot::RateCommand command;
  command.throttle = 0.6;
  signals_.command = command;
  EXPECT_EQ(throttle.value(), 0.6);
  EXPECT_EQ(kind.value(), 2.0);
  autopilot::AngleCommand other;
  other.throttle = 0.1;
  signals_.command = other;
  EXPECT_TRUE(std::isnan(throttle.value()));
}

TEST_F(SignalTableTest, AddressesAVectorAsAWhole) {
  truth_.p_NB_N = {1.0, 2.0, 2.0};
  const Signal p = table_.find("truth.p_NB_N");
  EXPECT_EQ(p.size(), 3);
  EXPECT_EQ(p.vector(), Eigen::Vector3d(1.0, 2.0, 2.0));
  EXPECT_EQ(Subject(p).magnitude(), 3.0);
}

TEST_F(SignalTableTest, GivesTheAnglesOfAnAttitude) {
  const double roll = 0.2, pitch = -0.4, heading = 2.9;
  truth_.q_NB = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(value("truth.roll"), roll, kSignalRoundOff);
  EXPECT_NEAR(value("truth.pitch"), pitch, kSignalRoundOff);
  EXPECT_NEAR(value("truth.heading"), heading, kSignalRoundOff);
  EXPECT_TRUE(table_.find("truth.heading").is_angle());
  // The estimate has angles of its own; they are not replaced.
  signals_.estimate.heading = 1.25;
  EXPECT_EQ(value("autopilot.estimate.heading"), 1.25);
}

TEST_F(SignalTableTest, NamesTheNearestPathsOfAnUnknownOne) {
  try {
    table_.find("truth.p_NB_M");
    FAIL() << "it was found";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("no signal truth.p_NB_M"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("truth.p_NB_N"));
  }
  EXPECT_THROW(table_.find("truth.q_NB"), std::invalid_argument);
}

TEST_F(SignalTableTest, ListsNoPathTwice) {
  EXPECT_THROW(table_.add("truth", truth_), std::invalid_argument);
}

TEST_F(SignalTableTest, ReadsTheMessagesOfTheWire) {
  hil_bridge::rosflight::RosflightOutputRaw outputs;
  hil_bridge::rosflight::Statustext text;
  table_.add("fcu.output_raw", outputs);
  table_.add("fcu.text", text);
  outputs.values[2] = 0.5F;
  text.severity = 3;
  EXPECT_EQ(value("fcu.output_raw.values[2]"), 0.5);
  EXPECT_EQ(value("fcu.text.severity"), 3.0);
}

TEST_F(SignalTableTest, GivesEveryLeafAUnitOrAGoodReason) {
  for (const SignalLeaf& leaf : table_.leaves()) {
    EXPECT_FALSE(leaf.unit.empty()) << leaf.path;
  }
}

TEST_F(SignalTableTest, SubtractsAnglesTheShortWay) {
  signals_.trajectory.heading = -3.1;
  signals_.estimate.heading = 3.1;
  const Subject error(table_.find("autopilot.estimate.heading"), table_.find("autopilot.trajectory.heading"));
  EXPECT_NEAR(error.magnitude(), 6.2 - 2.0 * std::numbers::pi, kSignalRoundOff);
}

TEST_F(SignalTableTest, RefusesDifferencesOfUnlikeThings) {
  EXPECT_THROW(Subject(table_.find("truth.p_NB_N"), table_.find("truth.v_NB_N")), std::invalid_argument);
  EXPECT_THROW(Subject(table_.find("truth.p_NB_N"), table_.find("truth.p_NB_N.x")), std::invalid_argument);
}

struct ConditionCase {
  const char* name;
  const char* text;
  double margin;
};
class ConditionTest : public SignalTableTest, public ::testing::WithParamInterface<ConditionCase> {};

TEST_P(ConditionTest, HasTheMarginOfItsComparison) {
  truth_.p_NB_N.z() = -5.0;
  truth_.in_contact = true;
  signals_.trajectory.reached = 3;
  signals_.flight.phase = autopilot::FlightPhase::kOffboard;
  const Condition condition = Condition::read(GetParam().text, table_);
  EXPECT_NEAR(condition.margin(), GetParam().margin, kSignalRoundOff);
  // At equality only the sign is left.
  if (GetParam().margin == 0.0) {
    EXPECT_NE(condition.margin(), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, ConditionTest,
    ::testing::Values(ConditionCase{"Equal", "autopilot.flight.phase == offboard", 1.0},
                      ConditionCase{"NotEqual", "autopilot.flight.phase == landing", -1.0},
                      ConditionCase{"Different", "autopilot.flight.phase != landing", 1.0},
                      ConditionCase{"Below", "truth.p_NB_N.z < -400 cm", 1.0},
                      ConditionCase{"Above", "truth.p_NB_N.z > -4", -1.0},
                      ConditionCase{"AtLeast", "autopilot.trajectory.reached >= 3", 0.0},
                      ConditionCase{"NotAbove", "autopilot.trajectory.reached > 3", 0.0},
                      ConditionCase{"Bool", "truth.in_contact == true", 1.0},
                      ConditionCase{"Alone", "truth.in_contact", 1.0},
                      ConditionCase{"Variant", "autopilot.command == silence_command", 1.0}),
    [](const auto& tested) { return tested.param.name; });

TEST_F(SignalTableTest, EqualityDecidesBetweenStrictAndNot) {
  signals_.trajectory.reached = 3;
  EXPECT_GT(Condition::read("autopilot.trajectory.reached >= 3", table_).margin(), 0.0);
  EXPECT_LT(Condition::read("autopilot.trajectory.reached > 3", table_).margin(), 0.0);
  EXPECT_GT(Condition::read("autopilot.trajectory.reached <= 3", table_).margin(), 0.0);
  EXPECT_LT(Condition::read("autopilot.trajectory.reached < 3", table_).margin(), 0.0);
}

TEST_F(SignalTableTest, RefusesConditionsThatDoNotFit) {
  EXPECT_THROW(Condition::read("autopilot.flight.phase == flying", table_), std::invalid_argument);
  EXPECT_THROW(Condition::read("truth.p_NB_N > 3 m", table_), std::invalid_argument);
  EXPECT_THROW(Condition::read("truth.p_NB_N.x > 3 deg", table_), std::invalid_argument);
  EXPECT_THROW(Condition::read("truth.nothing > 3", table_), std::invalid_argument);
}

}  // namespace
}  // namespace ironbird::scenarios
