#include "scenarios/bench/event_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;
using Waiting = EventNames::Waiting;

Scenario mission(std::size_t waypoints) {
  Scenario scenario;
  scenario.waypoints.resize(waypoints);
  return scenario;
}

EventConfig deed(const std::string& name, const std::string& after) {
  EventConfig event;
  event.name = name;
  event.after = after;
  event.request = OperatorWish::kLand;
  return event;
}

std::string of_deed(const Scenario& scenario, const std::string& name) {
  return EventNames(scenario).complaint(name, Waiting::kDeed);
}

TEST(EventNamesTest, KnowsWhatEveryFlightHas) {
  for (const char* name :
       {"armed", "unarmed", "take_off", "hold", "offboard", "landing", "landed", "lifted_off", "degraded",
        "phase:offboard", "waypoint_1", "route_finished", "fcu:anything"}) {
    EXPECT_EQ(of_deed(mission(3), name), "") << name;
  }
}

TEST(EventNamesTest, KnowsTheEventsOfThePosition) {
  for (const char* name : {"doubtful", "sure", "cause:position_doubtful"}) {
    EXPECT_EQ(of_deed(mission(3), name), "") << name;
  }
  for (const char* name : {"fixes_disagree", "position_reset", "origin_moved"}) {
    EXPECT_EQ(EventNames(mission(3)).complaint(name, Waiting::kCheck), "") << name;
    EXPECT_NE(of_deed(mission(3), name), "") << "its text is a distance: " << name;
  }
}

TEST(EventNamesTest, LetsAKillBeCheckedByItsKind) {
  EXPECT_EQ(EventNames(mission(3)).complaint("killed", Waiting::kCheck), "");
  EXPECT_NE(of_deed(mission(3), "killed"), "") << "its text says why";
}

TEST(EventNamesTest, KnowsWhatHappensOnAStand) {
  Scenario scenario = mission(3);
  EXPECT_NE(EventNames(scenario).complaint("stand:bus-off", Waiting::kCheck), "");
  scenario.fcu.stand = "can:can0";
  scenario.vehicle.rotors.resize(4);
  for (const char* name : {"stand", "stand:bus-off", "motor 3 is ready", "stand:motor 0 is not ready"}) {
    EXPECT_EQ(EventNames(scenario).complaint(name, Waiting::kCheck), "") << name;
  }
  EXPECT_NE(EventNames(scenario).complaint("motor 4 is ready", Waiting::kCheck), "");
}

TEST(EventNamesTest, CountsTheWaypointsThatThereCanBe) {
  Scenario scenario = mission(3);
  EXPECT_EQ(of_deed(scenario, "waypoint_3"), "");
  EXPECT_EQ(of_deed(scenario, "waypoint_4"), "there is no such event: the route ends at waypoint_3");
  EXPECT_NE(of_deed(scenario, "waypoint_0"), "");
  EventConfig detour = deed("detour", "");
  detour.request.reset();
  detour.add_waypoint.emplace();
  scenario.events = {detour};
  EXPECT_EQ(of_deed(scenario, "waypoint_4"), "");
  EventConfig homeward = deed("homeward", "");
  homeward.request = OperatorWish::kReturnToLaunch;
  scenario.events.push_back(homeward);
  EXPECT_EQ(of_deed(scenario, "waypoint_6"), "") << "the way home is counted on";
  EXPECT_NE(of_deed(scenario, "waypoint_7"), "");
  EventConfig again = deed("again", "");
  again.request = OperatorWish::kTakeOff;
  scenario.events.push_back(again);
  EXPECT_EQ(of_deed(scenario, "waypoint_10"), "");
  scenario.events = {detour};
  scenario.cyclic = true;
  EXPECT_EQ(of_deed(scenario, "waypoint_700"), "");
  EXPECT_NE(of_deed(scenario, "route_finished"), "");
}

TEST(EventNamesTest, KnowsTheScenariosOwnEvents) {
  Scenario scenario = mission(1);
  EventConfig gust = deed("gust", "");
  gust.request.reset();
  gust.fault = simulator::FaultKind::kWind;
  scenario.events = {gust, deed("", "gust")};
  EXPECT_EQ(of_deed(scenario, "gust"), "");
  EXPECT_EQ(of_deed(scenario, "land"), "");
  EXPECT_NE(of_deed(scenario, "fault_end:gust"), "") << "it lasts to the end";
  scenario.events[0].lasts = 2.0;
  EXPECT_EQ(of_deed(scenario, "fault_end:gust"), "");
  EXPECT_NE(of_deed(scenario, "fault"), "") << "a deed waits for one event, not for a kind";
  EXPECT_EQ(EventNames(scenario).complaint("fault", Waiting::kCheck), "");
}

TEST(EventNamesTest, FindsEventsThatWaitForThemselves) {
  Scenario scenario = mission(1);
  scenario.events = {deed("a", "b"), deed("b", "a"), deed("c", "landed"), deed("d", "c")};
  EXPECT_THAT(of_deed(scenario, "a"), HasSubstr("can never happen"));
  EXPECT_THAT(of_deed(scenario, "b"), HasSubstr("can never happen"));
  EXPECT_EQ(of_deed(scenario, "d"), "");
}

TEST(EventNamesTest, KnowsThatNobodyFliesWhatNobodyArms) {
  Scenario scenario = mission(1);
  scenario.pilot.automatic = false;
  EXPECT_NE(of_deed(scenario, "offboard"), "");
  EventConfig arm = deed("arm", "");
  arm.request.reset();
  arm.pilot = PilotAction::kArm;
  scenario.events = {arm};
  EXPECT_EQ(of_deed(scenario, "offboard"), "");
}

TEST(EventNamesTest, LetsNoOwnEventPassForOneOfTheRun) {
  const EventNames names(mission(3));
  for (const char* name :
       {"landing", "crashed", "armed", "lost", "doubtful", "estimate_lost", "waypoint_2", "route_finished",
        "killed", "position_reset", "fault", "refused", "phase", "request"}) {
    EXPECT_THAT(names.objection(name), HasSubstr("the run itself has events of this name")) << name;
  }
  EXPECT_THAT(names.objection("phase:landing"), HasSubstr("must be without ':'"));
  for (const char* name : {"5 s", "-1", "lifted_off + 1 s", "a + b", "+"})
    EXPECT_THAT(names.objection(name), HasSubstr("must neither begin with a number")) << name;
  for (const char* name : {"gust", "take_off_again", "landing_2", "waypoint_of_honour"})
    EXPECT_EQ(names.objection(name), "") << name;
}

TEST(EventNamesTest, KnowsTheRefusalsThatThereCanBe) {
  Scenario scenario = mission(1);
  scenario.events = {deed("home", "")};
  EXPECT_EQ(of_deed(scenario, "refused:home"), "");
  EXPECT_EQ(of_deed(scenario, "refused:take_off"), "") << "the pilot's own";
  EXPECT_NE(of_deed(scenario, "refused:hmoe"), "");
  EXPECT_NE(of_deed(scenario, "fcu:"), "") << "it never says nothing";
}

TEST(EventNamesTest, NamesTheNearest) {
  EXPECT_EQ(of_deed(mission(1), "offbord"), "there is no such event; did you mean 'offboard'?");
  EXPECT_THAT(of_deed(mission(1), "x"), HasSubstr("there are "));
}

}  // namespace
}  // namespace ironbird::scenarios
