#include "scenarios/fcu/fcu_verb.hpp"

#include <array>
#include <memory>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/verb_options.hpp"

namespace ironbird::scenarios {

namespace {

struct SubVerb {
  const char* name;
  const char* summary;
  FcuWork (*declare)(VerbOptions&);
};

constexpr std::array<SubVerb, 6> kSubVerbs = {{
    {"info", "say what is connected, and how well", declare_fcu_info},
    {"monitor", "watch it live; measure latencies", declare_fcu_monitor},
    {"params", "get, set, save, load, compare its parameters", declare_fcu_params},
    {"calibrate", "calibrate its IMU, gyro, barometer, pitot tube or trim", declare_fcu_calibrate},
    {"preflight", "list what speaks against a flight", declare_fcu_preflight},
    {"serve", "be a unit, for others to connect to", declare_fcu_serve},
}};

}  // namespace

Verb fcu_verb() {
  return {"fcu", "talk to a flight-control unit, or be one", [](VerbOptions& options) -> FcuWork {
            options.requires_verb();
            options.footer(
                "No motor command ever leaves through this verb; parameters are set and calibrations ordered "
                "only while the\n"
                "unit says that it is disarmed.\n"
                "Examples:\n"
                "  ironbird fcu serve scenarios/library/paper/three_waypoints.toml --pty /tmp/unit\n"
                "  ironbird fcu info --port /tmp/unit\n"
                "  ironbird fcu monitor --port /tmp/unit\n"
                "  ironbird fcu params --port /dev/ttyACM0 save before.yaml\n"
                "  ironbird fcu preflight --port /dev/ttyACM0 scenarios/library/paper/three_waypoints.toml");
            auto chosen = std::make_shared<FcuWork>();
            for (const SubVerb& sub : kSubVerbs) {
              options.verb(sub.name, sub.summary, [&](VerbOptions& of_sub) {
                return [chosen, work = sub.declare(of_sub)] { *chosen = work; };
              });
            }
            return [chosen](const autopilot::Modules& modules) { return (*chosen)(modules); };
          }};
}

}  // namespace ironbird::scenarios
