#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "autopilot/controller/cascaded_controller.hpp"
#include "autopilot/controller/phase_table.hpp"
#include "autopilot/handover.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;

// Every phase with every combination of inputs: few enough to look at all of them.

struct Walked {
  FlightPhase from;
  PhaseInputs in;
  PhaseStep next;
};

/// Sets the truth values of a described struct from the bits of `number`; returns how many there are.
template <class Described>
unsigned set_bits(Described& described, unsigned number) {
  unsigned count = 0;
  Described::describe(described, [&](std::string_view, auto& member, auto&&...) {
    if constexpr (std::is_same_v<decltype(member), bool&>) member = ((number >> count++) & 1U) != 0;
  });
  return count;
}

bool stands(const Walked& w) {
  return w.from == kDisarmed || ((w.from == kLanding || w.from == kLevelDescent) && w.in.on_ground);
}

template <class Of>
void for_all_combinations(const Of& of) {
  PhaseInputs in;
  const unsigned combinations = 1U << set_bits(in, 0);
  ASSERT_EQ(combinations, 1U << 15U);
  for (const auto& [from, name] : enumerators(FlightPhase{})) {
    for (unsigned number = 0; number < combinations; ++number) {
      set_bits(in, number);
      of(Walked{from, in, next_phase(from, in)});
      if (::testing::Test::HasFailure()) {
        FAIL() << "from " << name << " with the inputs 0x" << std::hex << number;
      }
    }
  }
}

TEST(PhaseWalkTest, LeavesTheGroundOnlyWhenATakeOffIsWantedArmedWithEstimateAndPosition) {
  for_all_combinations([](const Walked& w) {
    if (!stands(w)) return;
    EXPECT_TRUE(w.next.phase == w.from || w.next.phase == kDisarmed || w.next.phase == kTakeOff);
    if (w.next.phase != kTakeOff) return;
    EXPECT_TRUE(w.in.take_off_wanted && w.in.armed && w.in.estimate_usable && w.in.position_known &&
                !w.in.position_doubtful);
  });
}

TEST(PhaseWalkTest, BeginsAClimbNowhereButOnTheGround) {
  for_all_combinations([](const Walked& w) {
    if (w.next.phase == kTakeOff && w.from != kTakeOff) {
      EXPECT_TRUE(stands(w));
    }
  });
}

TEST(PhaseWalkTest, IsDisarmedWhateverElseIsSoWhenTheFcuIs) {
  for_all_combinations([](const Walked& w) {
    if (!w.in.armed) {
      EXPECT_EQ(w.next.phase, kDisarmed);
    }
  });
}

TEST(PhaseWalkTest, GivesUpAnArmedFlightOnlyAtRestWithThePilot) {
  for_all_combinations([](const Walked& w) {
    const bool given_up = w.in.armed && w.from != kDisarmed && w.next.phase == kDisarmed;
    EXPECT_EQ(given_up, w.in.armed && w.from != kDisarmed && w.in.rests_with_pilot);
  });
}

TEST(PhaseWalkTest, IsSilentDisarmedOrDownWithoutAnEstimate) {
  for_all_combinations([](const Walked& w) {
    if (w.in.estimate_usable) return;
    EXPECT_TRUE(w.next.phase == kSilent || w.next.phase == kDisarmed ||
                (stands(w) && w.next.phase == w.from));
  });
}

TEST(PhaseWalkTest, NeverAimsAtAPlaceWithoutAPosition) {
  for_all_combinations([](const Walked& w) {
    if (w.in.position_known) return;
    EXPECT_TRUE(w.next.phase == kDisarmed || w.next.phase == kSilent || w.next.phase == kLevelDescent ||
                (stands(w) && w.next.phase == w.from));
  });
}

TEST(PhaseWalkTest, FliesTheSetpointOnlyAfterAHoldWhenThereIsOneAndNoDoubt) {
  for_all_combinations([](const Walked& w) {
    if (w.next.phase != kOffboard) return;
    EXPECT_TRUE(w.in.setpoint_valid);
    EXPECT_TRUE(w.from == kOffboard || (w.from == kHold && w.in.hold_over));
    EXPECT_FALSE(w.in.position_doubtful);
  });
}

TEST(PhaseWalkTest, EndsADescentInTheAirOnlyToResumeOrWhenFlyingOnIsImpossible) {
  for_all_combinations([](const Walked& w) {
    const bool descends = w.from == kLanding || w.from == kLevelDescent;
    if (descends && w.next.phase == kHold) {
      EXPECT_TRUE(w.in.resume_wanted && !w.in.on_ground);
    }
    if (descends && !stands(w)) {
      EXPECT_TRUE(w.next.phase != kOffboard && w.next.phase != kTakeOff);
    }
  });
}

TEST(PhaseWalkTest, EndsASilenceInTheAirOnlySoonOrByRequest) {
  for_all_combinations([](const Walked& w) {
    if (w.from != kSilent || w.next.phase == kSilent || w.next.phase == kDisarmed) return;
    EXPECT_TRUE(w.in.estimate_usable);
    EXPECT_TRUE(w.in.silence_short || w.in.landing_wanted || w.in.resume_wanted);
  });
}

TEST(PhaseWalkTest, LandsFromEveryPhaseInTheAirWhenAskedToAndAble) {
  for_all_combinations([](const Walked& w) {
    if (w.from == kDisarmed || stands(w) || !w.in.armed || w.in.rests_with_pilot) return;
    if (!w.in.landing_wanted || w.in.resume_wanted || !w.in.estimate_usable) return;
    EXPECT_EQ(w.next.phase, w.in.position_known ? kLanding : kLevelDescent);
  });
}

TEST(PhaseWalkTest, GivesACauseOnlyForAChange) {
  for_all_combinations([](const Walked& w) {
    if (w.next.cause != PhaseCause::kPlanned) {
      EXPECT_NE(w.next.phase, w.from);
    }
  });
}

TEST(WishWalkTest, GrantsATakeOffOnlyStandingArmedInNobodyElsesHandsWithEstimateAndSurePosition) {
  WishConditions now;
  const unsigned combinations = 1U << set_bits(now, 0);
  for (const auto& [phase, name] : enumerators(FlightPhase{})) {
    for (unsigned number = 0; number < combinations; ++number) {
      now.phase = phase;
      set_bits(now, number);
      const bool ready = now.armed && !now.failsafe && !now.pilot_holds && now.estimate_usable &&
                         now.position_known && !now.position_doubtful &&
                         (phase == kDisarmed || now.on_ground) && !now.overturned;
      EXPECT_EQ(why_not(FlightWish::kTakeOff, now).empty(), ready) << name << " 0x" << std::hex << number;
    }
  }
}

// The controller on the ground, with everything that may change between a granted request and the step after.

struct Ground {
  bool armed = false;
  bool failsafe = false;
  bool pilot_holds = false;
  bool not_heard = false;
  bool estimate_lost = false;
  bool position_lost = false;
  bool something_to_fly = false;
  bool route_lands = false;
  bool asked_to_take_off = false;
  bool asked_to_land = false;
  bool asked_to_resume = false;
  bool take_off_on_arming = false;
  bool armed_just_now = false;
  bool zeros_while_disarmed = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("armed", self.armed);
    visit("failsafe", self.failsafe);
    visit("pilot_holds", self.pilot_holds);
    visit("not_heard", self.not_heard);
    visit("estimate_lost", self.estimate_lost);
    visit("position_lost", self.position_lost);
    visit("something_to_fly", self.something_to_fly);
    visit("route_lands", self.route_lands);
    visit("asked_to_take_off", self.asked_to_take_off);
    visit("asked_to_land", self.asked_to_land);
    visit("asked_to_resume", self.asked_to_resume);
    visit("take_off_on_arming", self.take_off_on_arming);
    visit("armed_just_now", self.armed_just_now);
    visit("zeros_while_disarmed", self.zeros_while_disarmed);
  }

  bool overridden() const { return failsafe || pilot_holds || not_heard; }

  /// Whoever armed just now was disarmed before, whatever the descent it had ended.
  bool may_take_off() const {
    const bool wanted = asked_to_take_off || (take_off_on_arming && armed_just_now && something_to_fly);
    return wanted && armed && !failsafe && !pilot_holds && !estimate_lost && !position_lost;
  }
};

bool pushes(const FcuCommand& command) {
  if (std::holds_alternative<SilenceCommand>(command)) return false;
  const auto* torque = std::get_if<PassThroughCommand>(&command);
  return torque == nullptr || torque->thrust != 0.0 || !torque->M_B.isZero(0.0);
}

class GroundWalkTest : public ::testing::TestWithParam<FlightPhase> {
 protected:
  /// A controller on the ground in the phase of the test; the requests are granted under good conditions.
  FcuCommand step(const Ground& g) {
    CascadedController controller;
    set_down(controller, g);
    FcuStatus status{.stamp = kFirst, .armed = true};
    StateEstimate estimate;
    estimate.stamp = kFirst;
    estimate.health = Health::kGood;
    if (g.armed_just_now) see_disarmed(controller, estimate, status);
    if (g.asked_to_take_off) {
      EXPECT_TRUE(ask(controller, FlightWish::kTakeOff, estimate, status));
    }
    if (g.asked_to_land) {
      EXPECT_FALSE(ask(controller, FlightWish::kLand, estimate, status));
    }
    if (g.asked_to_resume) {
      EXPECT_FALSE(ask(controller, FlightWish::kResume, estimate, status));
    }
    status.armed = g.armed;
    status.failsafe = g.failsafe;
    status.rc_override = (g.pilot_holds ? 0x1 : 0) | (g.not_heard ? 0x20 : 0);
    if (g.estimate_lost) estimate.health = Health::kLost;
    estimate.position_known = !g.position_lost;
    estimate.stamp += kStep;
    const ControlSetpoint something = AngleHeadingRateThrust{0.0, 0.0, 0.0, 38.0};
    const FcuCommand command =
        controller.run(g.something_to_fly ? something : NoSetpoint{}, g.route_lands, estimate, status);
    climbed_ = controller.phase() == kTakeOff;
    status = {.stamp = estimate.stamp, .armed = true};
    estimate.health = Health::kGood;
    estimate.position_known = true;
    estimate.stamp += kStep;
    pushes_later_ = pushes(controller.run(NoSetpoint{}, g.route_lands, estimate, status));
    return command;
  }

  bool climbed_ = false;
  bool pushes_later_ = false;  // when all is well again and nobody asks for anything

 private:
  static constexpr Time kFirst = std::chrono::milliseconds(10);
  static constexpr Time kStep = std::chrono::microseconds(2500);

  static void set_down(CascadedController& controller, const Ground& g) {
    CascadedControllerParams params = controller.params();
    params.take_off_on_arming = g.take_off_on_arming;
    params.zeros_while_disarmed = g.zeros_while_disarmed;
    controller.set_params(params);
    Signals signals;
    signals.flight.phase = GetParam();
    signals.flight.memory.on_ground = GetParam() != kDisarmed;
    signals.flight.memory.launched = GetParam() != kDisarmed;
    controller.take_over(signals);
  }

  static bool ask(CascadedController& controller, FlightWish wish, const StateEstimate& estimate,
                  const FcuStatus& status) {
    return controller.request(wish, estimate, status).accepted;
  }

  static void see_disarmed(CascadedController& controller, StateEstimate& estimate, FcuStatus& status) {
    status.armed = false;
    controller.run(NoSetpoint{}, false, estimate, status);
    status.armed = true;
    estimate.stamp += kStep;
  }
};

TEST_P(GroundWalkTest, NeverPushesExceptForATakeOffThatWasGrantedOrForArmingWhileNobodyElseHasIt) {
  Ground ground;
  const unsigned combinations = 1U << set_bits(ground, 0);
  int climbs = 0;
  for (unsigned number = 0; number < combinations; ++number) {
    set_bits(ground, number);
    const bool may = ground.may_take_off();
    ASSERT_EQ(pushes(step(ground)), may) << "0x" << std::hex << number;
    ASSERT_EQ(climbed_, may) << "0x" << std::hex << number;
    // Who had it while nothing was known of it may have flown it off.
    const bool may_be_elsewhere = ground.overridden() && ground.estimate_lost;
    if (!may_be_elsewhere) {
      ASSERT_EQ(pushes_later_, may) << "after 0x" << std::hex << number;
    }
    climbs += climbed_;
  }
  EXPECT_GT(climbs, 0) << "no combination was allowed to climb: the walk shows nothing";
}

INSTANTIATE_TEST_SUITE_P(Grounded, GroundWalkTest, ::testing::Values(kDisarmed, kLanding, kLevelDescent),
                         [](const auto& phase) {
                           for (const auto& [value, name] : enumerators(FlightPhase{})) {
                             if (value == phase.param) return std::string(name);
                           }
                           return std::string("unknown");
                         });

}  // namespace
}  // namespace ironbird::autopilot
