// What the flight's own events are made of.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenarios/requirements/timeline.hpp"

namespace ironbird::scenarios {
namespace {

class EventDetectorTest : public ::testing::Test {
 protected:
  EventDetectorTest() {
    signals_.trajectory.valid = true;
    signals_.route.revision = 1;
  }

  /// Shows the detector one tick. @return the events of the route that it told
  std::vector<std::string> look() {
    const std::size_t before = timeline_.events().size();
    detector_.observe(time_ += 0.01, timeline_);
    std::vector<std::string> told;
    for (std::size_t i = before; i < timeline_.events().size(); ++i) {
      if (timeline_.events()[i].kind == "waypoint") told.push_back(timeline_.events()[i].text);
    }
    return told;
  }

  using Told = std::vector<std::string>;

  autopilot::Signals signals_;
  EventDetector detector_{signals_};
  Timeline timeline_;
  double time_ = 0.0;
};

TEST_F(EventDetectorTest, TellsNoWaypointTwiceWhenThePathWasNotValidInBetween) {
  signals_.trajectory.reached = 1;
  EXPECT_EQ(look(), Told{"waypoint_1"});
  // GIVEN a point without anything to fly, whatever it says
  signals_.trajectory = {};
  EXPECT_EQ(look(), Told{});
  // WHEN the path comes back where it was
  signals_.trajectory.valid = true;
  signals_.trajectory.reached = 1;
  EXPECT_EQ(look(), Told{});
  signals_.trajectory.reached = 2;
  EXPECT_EQ(look(), Told{"waypoint_2"});
}

TEST_F(EventDetectorTest, CountsOnWhenARouteBeginsAnew) {
  signals_.trajectory.reached = 2;
  EXPECT_EQ(look(), (Told{"waypoint_1", "waypoint_2"}));
  signals_.trajectory.reached = 0;
  EXPECT_EQ(look(), Told{});
  signals_.trajectory.reached = 1;
  EXPECT_EQ(look(), Told{"waypoint_3"});
}

TEST_F(EventDetectorTest, TellsTheEndOfARouteOnce) {
  signals_.trajectory.reached = 1;
  signals_.trajectory.finished = true;
  EXPECT_EQ(look(), (Told{"waypoint_1", "route_finished"}));
  // WHEN the path is lost and the vehicle makes its way back to the end
  signals_.trajectory.valid = signals_.trajectory.finished = false;
  look();
  signals_.trajectory.valid = true;
  look();
  signals_.trajectory.finished = true;
  EXPECT_EQ(look(), Told{});
  // THEN only another route has another end
  signals_.route.revision = 2;
  EXPECT_EQ(look(), Told{"route_finished"});
}

}  // namespace
}  // namespace ironbird::scenarios
