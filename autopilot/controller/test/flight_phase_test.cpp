#include "autopilot/controller/phase_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "autopilot/controller/touch_down.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;
using enum PhaseCause;

constexpr std::string_view kNoRow = "";

struct Case {
  const char* name;
  std::string_view row;
  FlightPhase from;
  PhaseInputs in;
  FlightPhase to;
  PhaseCause cause = PhaseCause::kPlanned;
};

PhaseInputs armed(void (*change)(PhaseInputs&)) {
  PhaseInputs in;
  in.armed = true;
  in.estimate_usable = true;
  change(in);
  return in;
}

PhaseInputs everything_but_armed() {
  return {.armed = false,
          .estimate_usable = true,
          .take_off_wanted = true,
          .height_reached = true,
          .hold_over = true,
          .setpoint_valid = true,
          .route_lands = true,
          .landing_wanted = true,
          .on_ground = true};
}

class FlightPhaseTest : public ::testing::TestWithParam<Case> {};

TEST_P(FlightPhaseTest, GoesWhereTheTableSays) {
  EXPECT_EQ(next_phase(GetParam().from, GetParam().in), (PhaseStep{GetParam().to, GetParam().cause}));
}

TEST_P(FlightPhaseTest, IsDecidedByTheRowThatTheCaseNames) {
  const PhaseRow* const row = deciding_row(GetParam().from, GetParam().in);
  EXPECT_EQ(row == nullptr ? kNoRow : row->name, GetParam().row);
}

const auto kNothing = [](PhaseInputs&) {};
const auto no_position = [](PhaseInputs& i) {
  i.position_known = false;
  i.setpoint_valid = i.hold_over = true;
};
const auto no_estimate = [](PhaseInputs& i) { i.estimate_usable = false; };
const auto rests = [](PhaseInputs& i) { i.rests_with_pilot = i.setpoint_valid = i.hold_over = true; };

const auto kCases = std::to_array<Case>(
    {Case{"DisarmedStays", "disarms", kDisarmed, everything_but_armed(), kDisarmed},
     Case{"TakeOffIsDisarmed", "disarms", kTakeOff, everything_but_armed(), kDisarmed},
     Case{"HoldIsDisarmed", "disarms", kHold, everything_but_armed(), kDisarmed},
     Case{"OffboardIsDisarmed", "disarms", kOffboard, everything_but_armed(), kDisarmed},
     Case{"LandingIsDisarmed", "disarms", kLanding, everything_but_armed(), kDisarmed},
     Case{"ArmedWaitsForARequest", kNoRow, kDisarmed, armed([](PhaseInputs& i) { i.setpoint_valid = true; }),
          kDisarmed},
     Case{"ArmedTakesOff", "takes off", kDisarmed, armed([](PhaseInputs& i) { i.take_off_wanted = true; }),
          kTakeOff},
     Case{"NoTakeOffWithoutAnEstimate", kNoRow, kDisarmed, armed([](PhaseInputs& i) {
            i.take_off_wanted = true;
            i.estimate_usable = false;
          }),
          kDisarmed},
     Case{"NoLandingOnTheGround", kNoRow, kDisarmed, armed([](PhaseInputs& i) { i.landing_wanted = true; }),
          kDisarmed},
     Case{"Climbs", kNoRow, kTakeOff, armed(kNothing), kTakeOff},
     Case{"HasClimbed", "has climbed", kTakeOff, armed([](PhaseInputs& i) { i.height_reached = true; }),
          kHold},
     Case{"LandsFromTheClimb", "lands from climb", kTakeOff,
          armed([](PhaseInputs& i) { i.landing_wanted = i.height_reached = true; }), kLanding},
     Case{"Holds", kNoRow, kHold, armed([](PhaseInputs& i) { i.setpoint_valid = true; }), kHold},
     Case{"HoldsWithNothingToFly", kNoRow, kHold, armed([](PhaseInputs& i) { i.hold_over = true; }), kHold},
     Case{"FliesAfterTheHold", "flies", kHold,
          armed([](PhaseInputs& i) { i.hold_over = i.setpoint_valid = true; }), kOffboard},
     Case{"LandsFromTheHold", "lands from hold", kHold,
          armed([](PhaseInputs& i) { i.landing_wanted = i.hold_over = i.setpoint_valid = true; }), kLanding},
     Case{"IgnoresALandingOfTheRouteInTheHold", kNoRow, kHold,
          armed([](PhaseInputs& i) { i.route_lands = true; }), kHold},
     Case{"FliesOn", kNoRow, kOffboard, armed([](PhaseInputs& i) { i.setpoint_valid = true; }), kOffboard},
     Case{"HoldsWhenTheSetpointIsGone", "holds", kOffboard, armed(kNothing), kHold},
     Case{"LandsByRequest", "lands from route", kOffboard,
          armed([](PhaseInputs& i) { i.landing_wanted = true; }), kLanding},
     Case{"LandsByRoute", "lands from route", kOffboard,
          armed([](PhaseInputs& i) { i.route_lands = i.setpoint_valid = true; }), kLanding},
     Case{"IgnoresAStaleLandingOfTheRoute", "holds", kOffboard,
          armed([](PhaseInputs& i) { i.route_lands = true; }), kHold},
     Case{"Descends", kNoRow, kLanding, armed([](PhaseInputs& i) { i.setpoint_valid = i.hold_over = true; }),
          kLanding},
     Case{"StaysDown", "stays down", kLanding,
          armed([](PhaseInputs& i) { i.on_ground = i.setpoint_valid = true; }), kLanding},
     Case{"TakesOffAgainFromTheGround", "takes off again", kLanding,
          armed([](PhaseInputs& i) { i.on_ground = i.take_off_wanted = true; }), kTakeOff},
     Case{"DoesNotTakeOffWhileDescending", kNoRow, kLanding,
          armed([](PhaseInputs& i) { i.take_off_wanted = true; }), kLanding},
     Case{"NoTakeOffWithoutAPosition", kNoRow, kDisarmed, armed([](PhaseInputs& i) {
            i.take_off_wanted = true;
            i.position_known = false;
          }),
          kDisarmed},
     Case{"ClimbEndsWithoutAPosition", "loses position", kTakeOff, armed(no_position), kLevelDescent,
          kPositionUnknown},
     Case{"HoldEndsWithoutAPosition", "loses position", kHold, armed(no_position), kLevelDescent,
          kPositionUnknown},
     Case{"OffboardEndsWithoutAPosition", "loses position", kOffboard, armed(no_position), kLevelDescent,
          kPositionUnknown},
     Case{"LandingGoesOnLevelWithoutAPosition", "loses position", kLanding, armed(no_position), kLevelDescent,
          kPositionUnknown},
     Case{"SinksLevel", kNoRow, kLevelDescent, armed(no_position), kLevelDescent},
     Case{"LandsWhenThePositionIsBack", "lands with position", kLevelDescent,
          armed([](PhaseInputs& i) { i.setpoint_valid = i.hold_over = true; }), kLanding, kPositionKnown},
     Case{"HoldsByRequestWhenThePositionIsBack", "resumes with position", kLevelDescent,
          armed([](PhaseInputs& i) { i.resume_wanted = true; }), kHold, kPositionKnown},
     Case{"HoldsInDoubt", "holds in doubt", kOffboard,
          armed([](PhaseInputs& i) { i.position_doubtful = i.setpoint_valid = true; }), kHold,
          kPositionDoubtful},
     Case{"GoesOnHoldingInDoubt", kNoRow, kHold,
          armed([](PhaseInputs& i) { i.position_doubtful = i.setpoint_valid = i.hold_over = true; }), kHold},
     Case{"LandsInLongDoubt", "lands in doubt", kHold,
          armed([](PhaseInputs& i) { i.position_doubtful = i.doubt_long = true; }), kLanding,
          kPositionDoubtful},
     Case{"LandsByRouteInDoubt", "lands from route", kOffboard,
          armed([](PhaseInputs& i) { i.position_doubtful = i.setpoint_valid = i.route_lands = true; }),
          kLanding},
     Case{"NoTakeOffInDoubt", kNoRow, kDisarmed,
          armed([](PhaseInputs& i) { i.take_off_wanted = i.position_doubtful = true; }), kDisarmed},
     Case{"ClimbFallsSilent", "falls silent", kTakeOff, armed(no_estimate), kSilent, kEstimateLost},
     Case{"HoldFallsSilent", "falls silent", kHold, armed(no_estimate), kSilent, kEstimateLost},
     Case{"OffboardFallsSilent", "falls silent", kOffboard, armed(no_estimate), kSilent, kEstimateLost},
     Case{"LandingFallsSilent", "falls silent", kLanding, armed(no_estimate), kSilent, kEstimateLost},
     Case{"LevelDescentFallsSilent", "falls silent", kLevelDescent, armed(no_estimate), kSilent,
          kEstimateLost},
     Case{"OnTheGroundItNeedsNoEstimate", "stays down", kLanding, armed([](PhaseInputs& i) {
            i.estimate_usable = false;
            i.on_ground = true;
          }),
          kLanding},
     Case{"StaysSilent", kNoRow, kSilent,
          armed([](PhaseInputs& i) { i.setpoint_valid = i.hold_over = i.take_off_wanted = true; }), kSilent},
     Case{"LandsAfterAShortSilence", "lands after silence", kSilent,
          armed([](PhaseInputs& i) { i.silence_short = true; }), kLanding, kEstimateBack},
     Case{"SinksLevelAfterAShortSilence", "sinks after silence", kSilent, armed([](PhaseInputs& i) {
            i.silence_short = true;
            i.position_known = false;
          }),
          kLevelDescent, kEstimateBack},
     Case{"LandsAfterALongSilenceByRequest", "lands after silence", kSilent,
          armed([](PhaseInputs& i) { i.landing_wanted = true; }), kLanding, kEstimateBack},
     Case{"HoldsAfterALongSilenceByRequest", "resumes after silence", kSilent,
          armed([](PhaseInputs& i) { i.resume_wanted = true; }), kHold},
     Case{"EndsALandingByRequest", "resumes", kLanding, armed([](PhaseInputs& i) { i.resume_wanted = true; }),
          kHold},
     Case{"ClimbEndsAtRest", "rests", kTakeOff, armed(rests), kDisarmed, kRestsWithPilot},
     Case{"HoldEndsAtRest", "rests", kHold, armed(rests), kDisarmed, kRestsWithPilot},
     Case{"OffboardEndsAtRest", "rests", kOffboard, armed(rests), kDisarmed, kRestsWithPilot},
     Case{"LandingEndsAtRest", "rests", kLanding, armed(rests), kDisarmed, kRestsWithPilot},
     Case{"LevelDescentEndsAtRest", "rests", kLevelDescent, armed(rests), kDisarmed, kRestsWithPilot},
     Case{"SilenceEndsAtRest", "rests", kSilent, armed(rests), kDisarmed, kRestsWithPilot},
     Case{"LevelDescentIsDisarmed", "disarms", kLevelDescent, everything_but_armed(), kDisarmed},
     Case{"SilentIsDisarmed", "disarms", kSilent, everything_but_armed(), kDisarmed},
     Case{"StaysDownAfterALevelDescent", "stays down", kLevelDescent,
          armed([](PhaseInputs& i) { i.on_ground = i.setpoint_valid = true; }), kLevelDescent},
     Case{"TakesOffAgainAfterALevelDescent", "takes off again", kLevelDescent,
          armed([](PhaseInputs& i) { i.on_ground = i.take_off_wanted = true; }), kTakeOff}});

INSTANTIATE_TEST_SUITE_P(Rows, FlightPhaseTest, ::testing::ValuesIn(kCases),
                         [](const auto& case_) { return case_.param.name; });

TEST(PhaseTableTest, HasACaseForEachRowFromEachPhaseThatTheRowStartsIn) {
  for (const PhaseRow& row : phase_table::kRows) {
    for (const auto& [phase, name] : enumerators(FlightPhase{})) {
      if (!row.from.contains(phase)) continue;
      EXPECT_TRUE(std::ranges::any_of(
          kCases, [&, phase = phase](const Case& c) { return c.from == phase && c.row == row.name; }))
          << row.name << " from " << name;
    }
  }
}

TEST(PhaseTableTest, NamesEachRowOnce) {
  std::set<std::string_view> names;
  for (const PhaseRow& row : phase_table::kRows) EXPECT_TRUE(names.insert(row.name).second) << row.name;
}

template <class Enum>
std::string_view word(Enum value) {
  for (const auto& [candidate, name] : enumerators(value)) {
    if (candidate == value) return name;
  }
  return "?";
}

std::string words(PhaseSet phases) {
  if (phases == phase_table::kAny) return "any";
  if (phases == phase_table::kAnyButDisarmed) return "any but disarmed";
  std::string all;
  for (const auto& [phase, name] : enumerators(FlightPhase{})) {
    if (phases.contains(phase)) all += (all.empty() ? "" : ", ") + std::string(name);
  }
  return all;
}

/// The table as the document shows it.
std::string markdown() {
  std::ostringstream out;
  out << "| row | from | to | when | cause |\n|---|---|---|---|---|\n";
  for (const PhaseRow& row : phase_table::kRows) {
    out << "| " << row.name << " | " << words(row.from) << " | " << (row.to ? word(*row.to) : "the same")
        << " | " << row.when << " | " << word(row.cause) << " |\n";
  }
  return out.str();
}

TEST(PhaseTableTest, IsTheTableOfTheDocument) {
  std::ifstream file(IRONBIRD_SOURCE_DIR "/docs/equations_control.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(document.find("\n\n" + markdown() + "\n"), std::string::npos) << "the table is now\n"
                                                                          << markdown();
}

TEST(TouchDownTest, IsFeltWhenNothingMovesUnderLittleLiftForAWhile) {
  TouchDown touch_down;
  using std::chrono::milliseconds;
  const auto feel = [&](int at, double lift, double v_down) {
    return touch_down.feel(milliseconds(at), lift, v_down, 0.15, 0.95, 1.0);
  };
  EXPECT_FALSE(feel(0, 0.8, 0.4)) << "it sinks";
  EXPECT_FALSE(feel(100, 0.8, 0.0));
  EXPECT_FALSE(feel(900, 0.8, 0.0));
  EXPECT_FALSE(feel(1000, 1.0, 0.0)) << "it is carried: the wait begins anew";
  EXPECT_FALSE(feel(1100, 0.8, 0.0));
  EXPECT_FALSE(feel(2099, 0.8, 0.1));
  EXPECT_TRUE(feel(2100, 0.8, -0.1));
  EXPECT_TRUE(feel(2200, 1.0, 1.0)) << "it stays felt";
  touch_down.reset();
  EXPECT_FALSE(touch_down.felt());
}

}  // namespace
}  // namespace ironbird::autopilot
