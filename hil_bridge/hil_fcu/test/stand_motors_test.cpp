#include "hil_bridge/hil_fcu/stand_motors.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "hil_bridge/can/esc_bus.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"

// Rule R11 of docs/safety.md.

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;

constexpr Time kStandPeriod = std::chrono::microseconds(2500);
constexpr std::array kThrottles = {0.25, 0.5, 0.75, 1.0};

/// Four real motor controllers, played, that turn by whatever the bus tells them; the gate is set by hand.
class Stand {
 public:
  Stand() : escs_({.require_arming = false}, bus_.attach(), Time{0}) {
    motors_ = std::make_unique<StandMotors>(can::EscControllerParams{}, bus_.attach(), gate, Time{0});
  }

  void run(int periods) {
    for (int k = 0; k < periods; ++k) {
      now += kStandPeriod;
      if (wants) motors_->want(*wants, now - age);
      if (motors_) motors_->step(now);
      bus_.advance(now + kStandPeriod);
      escs_.step(readings_, now + kStandPeriod);
    }
  }
  /// The greatest throttle of the four, and why.
  double turning() const {
    double greatest = 0.0;
    for (const can::EscCommand& command : escs_.commands()) greatest = std::max(greatest, command.throttle);
    return greatest;
  }
  can::EscCondition condition() const { return escs_.commands()[3].condition; }
  StandMotors& motors() { return *motors_; }
  void end() { motors_.reset(); }

  InterlockStatus gate;
  std::optional<std::array<double, 4>> wants = kThrottles;
  Time age{0};
  Time now{0};

 private:
  transport::InProcessBus bus_;
  can::EscBus escs_;
  std::unique_ptr<StandMotors> motors_;
  std::array<can::EscReading, 4> readings_{};
};

TEST(StandMotorsTest, TurnsMotorsOnlyWhileTheGateIsLive) {
  for (const InterlockState state : kInterlockStates) {
    Stand stand;
    stand.gate.state = state;
    stand.run(100);
    if (state == InterlockState::kLive) {
      EXPECT_NEAR(stand.turning(), 1.0, 1e-3);
      EXPECT_EQ(stand.motors().status().refused, 0U);
    } else {
      EXPECT_EQ(stand.turning(), 0.0) << name_of(state);
      EXPECT_EQ(stand.motors().status().refused, 100U) << name_of(state);
    }
  }
}

TEST(StandMotorsTest, SendsNothingAtAllBeforeAnOperatorHasReleasedTheRun) {
  Stand stand;
  stand.gate.state = InterlockState::kVerified;
  stand.run(100);
  EXPECT_EQ(stand.condition(), can::EscCondition::kNeverCommanded);
  stand.gate.state = InterlockState::kReleased;
  stand.run(2);
  EXPECT_EQ(stand.condition(), can::EscCondition::kDisarmed) << "zeros, and the word that none may turn";
}

TEST(StandMotorsTest, EndsInExplicitZerosWhenTheGateCloses) {
  for (const InterlockState state : kInterlockStates) {
    if (state == InterlockState::kLive) continue;
    Stand stand;
    stand.gate.state = InterlockState::kLive;
    stand.run(100);
    ASSERT_GT(stand.turning(), 0.0);
    stand.gate.state = state;
    stand.run(1);
    EXPECT_EQ(stand.turning(), 0.0) << name_of(state);
    stand.run(200);
    // Not the controllers' own time-out: zeros go on coming.
    EXPECT_EQ(stand.condition(), can::EscCondition::kDisarmed) << name_of(state);
  }
}

TEST(StandMotorsTest, EndsInExplicitZerosWhenItIsTakenDown) {
  Stand stand;
  stand.gate.state = InterlockState::kLive;
  stand.run(10);
  stand.wants.reset();
  stand.end();
  stand.run(1);
  EXPECT_EQ(stand.turning(), 0.0);
  EXPECT_EQ(stand.condition(), can::EscCondition::kRunning) << "a command of zero, not silence";
}

TEST(StandMotorsTest, TakesNoCommandThatIsOldBrokenOrForOtherMotors) {
  const auto turning_with = [](auto&& spoil) {
    Stand stand;
    stand.gate.state = InterlockState::kLive;
    stand.run(10);
    spoil(stand);
    stand.run(1);
    return stand.turning();
  };
  EXPECT_GT(turning_with([](Stand&) {}), 0.0);
  EXPECT_GT(turning_with([](Stand& stand) { stand.age = milliseconds(50); }), 0.0);
  EXPECT_EQ(turning_with([](Stand& stand) { stand.age = milliseconds(51); }), 0.0);
  EXPECT_EQ(turning_with([](Stand& stand) { stand.age = -milliseconds(1); }), 0.0) << "from the future";
  for (const double nonsense :
       {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(turning_with([&](Stand& stand) { (*stand.wants)[2] = nonsense; }), 0.0) << nonsense;
  }
  EXPECT_EQ(turning_with([](Stand& stand) {
              stand.wants.reset();
              stand.motors().want(std::span(kThrottles).first(3), stand.now);
            }),
            0.0);
}

}  // namespace
}  // namespace ironbird::hil_bridge
