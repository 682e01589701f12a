#include <cstdio>
#include <memory>
#include <string>

#include "hil_bridge/serial_fcu/calibration_client.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/fcu/fcu_verb.hpp"
#include "scenarios/fcu/unit_line.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::CalibrationClient;
using hil_bridge::CalibrationKind;
using hil_bridge::CalibrationState;

constexpr double kCalibrationPatience = 60.0;  // s; the calibration has its own

struct CalibrateArguments {
  UnitAddress address;
  std::string what;
  bool keep = false;
};

const CalibrationKind& kind_named(const std::string& name) {
  if (const CalibrationKind* kind = hil_bridge::find_calibration(name)) return *kind;
  std::string all;
  for (const CalibrationKind& kind : hil_bridge::calibration_kinds())
    all += (all.empty() ? "" : ", ") + std::string(kind.name);
  throw ConfigError(name + ": cannot be calibrated; there are: " + all);
}

int tell(const CalibrationClient& calibration, const CalibrationKind& kind) {
  const std::string name(kind.name);
  if (calibration.state() == CalibrationState::kDone) {
    std::fprintf(stderr, "%s: calibrated\n", name.c_str());
    for (const auto& change : calibration.changes()) {
      std::printf("%-16s was %s, is %s\n", change.name.c_str(), hil_bridge::value_text(change.before).c_str(),
                  hil_bridge::value_text(change.now).c_str());
    }
    return kExitPass;
  }
  std::fprintf(stderr, "%s: not calibrated: %s\n", name.c_str(), calibration.reason().c_str());
  return calibration.state() == CalibrationState::kFailed ? kExitFail : kExitHardware;
}

int calibrate(const CalibrateArguments& arguments) {
  note_interrupts();
  const CalibrationKind& kind = kind_named(arguments.what);
  UnitOnLine unit(arguments.address);
  unit.meet();
  if (!unit.until(1.0, [&] { return unit.connection().disarmed(unit.now()); })) {
    throw hil_bridge::transport::LinkError(
        "the unit does not report that it is disarmed; nothing was ordered. Disarm it first");
  }
  std::fprintf(stderr, "%s: needs that %s\n", std::string(kind.name).c_str(),
               std::string(kind.wants).c_str());
  CalibrationClient calibration(kind, unit.connection().parameters());
  unit.listen([&](const hil_bridge::Arrival& arrival) { calibration.take(arrival.message, unit.now()); });
  unit.until(kCalibrationPatience, [&] {
    calibration.advance(unit.now(), [&](const auto& message) { unit.fcu().send(message); });
    return calibration.over();
  });
  if (interrupt_requested()) return kExitInterrupted;
  const int code = tell(calibration, kind);
  if (code != kExitPass) return code;
  if (arguments.keep) return unit.keep() ? kExitPass : kExitHardware;
  std::fputs("not kept over a restart; --keep writes it to the unit's flash\n", stderr);
  return code;
}

}  // namespace

FcuWork declare_fcu_calibrate(VerbOptions& options) {
  auto arguments = std::make_shared<CalibrateArguments>();
  add_unit_address(options, arguments->address);
  options.option("what", arguments->what, "imu, gyro, baro, airspeed or rc-trim").required();
  options.flag("--keep", arguments->keep, "write the result to the unit's flash");
  options.footer(
      "Only while the unit says that it is disarmed. Done when the unit has told its result; exit code 1 "
      "when "
      "it says that\n"
      "it failed. rc-trim adds to the trim that there is.\n"
      "Examples:\n"
      "  ironbird fcu calibrate --port /dev/ttyACM0 imu --keep\n"
      "  ironbird fcu calibrate --port /dev/ttyACM0 baro");
  return [arguments](const autopilot::Modules&) { return calibrate(*arguments); };
}

}  // namespace ironbird::scenarios
