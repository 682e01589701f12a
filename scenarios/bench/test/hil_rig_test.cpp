#include "scenarios/bench/hil_rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "autopilot/modules.hpp"
#include "hil_bridge/interlock/gate.hpp"
#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/bench/world_maker.hpp"

namespace ironbird::scenarios {
namespace {

using hil_bridge::Time;
using hil_bridge::transport::LinkError;
using testing::HasSubstr;

class HilRigTest : public testing::Test {
 protected:
  HilRigTest() {
    const std::string file = IRONBIRD_SOURCE_DIR "/scenarios/library/hardware/hil_can.toml";
    scenario_ = load_scenario(file, {}, autopilot::standard_modules()).scenario;
    world_ = make_world(scenario_);
  }
  /// What is said when this rig is wanted.
  std::string refusal() {
    try {
      make_hil_rig(scenario_, *world_, false);
    } catch (const LinkError& error) {
      return error.what();
    }
    return "";
  }

  Scenario scenario_;
  std::unique_ptr<simulator::World> world_;
};

TEST_F(HilRigTest, SaysWhatIsWrongWithALineOrAnInterface) {
  scenario_.fcu.line = "/dev/no_such_port";
  EXPECT_THAT(refusal(), HasSubstr("/dev/no_such_port: there is no such port"));
  hil_bridge::transport::PseudoTerminal terminal;
  scenario_.fcu.line = terminal.device();
  scenario_.fcu.motors = "can:nocan0";
  EXPECT_THAT(refusal(), HasSubstr("CAN interface nocan0: "));
  scenario_.fcu.line = "udp:localhost:fast";
  EXPECT_THROW(make_hil_rig(scenario_, *world_, false), std::invalid_argument);
}

TEST_F(HilRigTest, SendsNothingThatActsBeforeItHasAGate) {
  const std::unique_ptr<HilRig> rig = make_hil_rig(scenario_, *world_, false);
  const auto fly = [&](Time from, Time until) {
    for (Time now = from; now < until; now += scenario_.fcu.tick) {
      rig->fcu().send(
          hil_bridge::rosflight::OffboardControl{.u = {0.0F, 0.0F, -50.0F}, .ignore = 0, .mode = 0});
      rig->fcu().advance(now);
    }
  };
  rig->pilot()->arm(true);
  rig->pilot()->override_companion(false);
  fly(scenario_.fcu.tick, std::chrono::seconds(6));
  const double without = world_->truth().rotor_speed[0];
  hil_bridge::SimulatedUnitGate gate;
  rig->set_gate(gate);
  fly(std::chrono::seconds(6), std::chrono::seconds(7));
  EXPECT_LT(without, 0.7 * world_->truth().rotor_speed[0]) << "armed, and idling";
}

}  // namespace
}  // namespace ironbird::scenarios
