#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "hil_bridge/executive/real_time_rights.hpp"
#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/transport/link_fault.hpp"
#include "hil_bridge/transport/machine_clock.hpp"
#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "hil_bridge/transport/socket_can.hpp"
#include "hil_bridge/transport/udp_socket.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/scenario_arguments.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/fcu/fcu_verb.hpp"
#include "scenarios/fcu/serve.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;
using hil_bridge::transport::ByteStream;
using hil_bridge::transport::LinkError;
using hil_bridge::transport::LinkFault;
using hil_bridge::transport::machine_time;
using hil_bridge::transport::PseudoTerminal;
using hil_bridge::transport::SocketCan;
using hil_bridge::transport::SocketCanParams;
using hil_bridge::transport::udp_peer;
using hil_bridge::transport::UdpConfig;
using hil_bridge::transport::UdpSocket;

// So far behind the clock there is no catching up: the clock is set anew and the loss told.
constexpr Time kGivenUp = std::chrono::milliseconds(200);
constexpr Time kServeTellPeriod = std::chrono::seconds(1);
constexpr int kLeastRest = 10;  // parts of a period, of which one is rest

struct ServeArguments {
  std::string scenario;
  std::vector<std::string> settings;
  std::string pty;
  int udp = 0;
  std::string udp_to;
  double duration = 0.0;  // s
  bool idle_pilot = false;
  std::string can;
  bool can_fd = false;
  bool on_desk = false;
  double time_scale = 1.0;
};

/// Where others find it, and what to type there.
struct Line {
  std::unique_ptr<ByteStream> stream;
  std::string how_to_reach;
};

/// Where the companion is, which has the usual port unless another is named.
UdpConfig companion(const std::string& text) {
  const bool names_port = text.find(':') != std::string::npos;
  const std::string usual = ":" + std::to_string(UdpConfig{}.local_port);
  const auto peer = udp_peer(names_port ? text : text + usual);
  if (peer && std::count(text.begin(), text.end(), ':') < 2) return *peer;
  throw ConfigError("--udp-to = " + text + ": must be HOST or HOST:PORT, for example localhost:14520");
}

/// What whoever is there has to type.
std::string udp_from_there(const UdpConfig& config) {
  const bool here = config.host == "localhost" || config.host == "127.0.0.1";
  const std::string own = config.port == UdpConfig{}.local_port ? "" : ":" + std::to_string(config.port);
  return "--udp " + std::string(here ? "localhost" : "THIS_MACHINE") + ":" +
         std::to_string(config.local_port) + own + (here ? "" : " at " + config.host);
}

Line open_line(const ServeArguments& arguments) {
  if (arguments.pty.empty() == (arguments.udp == 0)) {
    throw ConfigError("say how others reach the unit: either --pty LINK or --udp PORT");
  }
  if (arguments.udp == 0 && !arguments.udp_to.empty()) {
    throw ConfigError("--udp-to = " + arguments.udp_to + ": goes with --udp PORT only");
  }
  if (arguments.udp != 0) {
    UdpConfig config = companion(arguments.udp_to.empty() ? "localhost" : arguments.udp_to);
    config.local_port = arguments.udp;
    auto socket = std::make_unique<UdpSocket>(config);
    socket->open();
    return {std::move(socket), udp_from_there(config)};
  }
  return {std::make_unique<PseudoTerminal>(arguments.pty), "--port " + arguments.pty};
}

/// The line with the scenario's faults, where it has some.
class ServedLine {
 public:
  ServedLine(const ServeArguments& arguments, const LoadedScenario& loaded) : line_(open_line(arguments)) {
    if (!loaded.gives("link")) return;
    spoiled_.emplace(*line_.stream, loaded.scenario.link, loaded.scenario.seed,
                     &hil_bridge::rosflight::piece_length);
  }
  ByteStream& stream() { return spoiled_ ? static_cast<ByteStream&>(*spoiled_) : *line_.stream; }
  const std::string& how_to_reach() const { return line_.how_to_reach; }
  void advance(Time now) {
    if (!spoiled_) return;
    spoiled_->advance(now);
    if (!spoiled_->is_up()) spoiled_->reopen();
  }

 private:
  Line line_;
  std::optional<LinkFault> spoiled_;
};

/// The bus of the motors, or null. What is wrong with it is a matter of the machine, not of the command line.
std::unique_ptr<SocketCan> open_bus(const ServeArguments& arguments) {
  if (arguments.can.empty()) return nullptr;
  SocketCanParams params;
  params.interface = arguments.can;
  params.fd = arguments.can_fd;
  try {
    return std::make_unique<SocketCan>(params, machine_time());
  } catch (const std::invalid_argument& error) {
    throw LinkError(error.what());
  }
}

/// Says what happens to the bus.
void tell_events(SocketCan* bus, const std::string& interface) {
  while (bus != nullptr) {
    const auto event = bus->take_event();
    if (!event) return;
    const std::string_view name = name_of(event->kind);
    std::fprintf(stderr, "CAN interface %s: %.*s\n", interface.c_str(), static_cast<int>(name.size()),
                 name.data());
  }
}

void tell(const ServedUnit& unit, Time lost) {
  const simulator::Truth& truth = unit.world().truth();
  std::fprintf(stderr, "\r%8.1f s  %s  height %6.2f m  %llu kB out  %llu kB in%s", to_seconds(unit.now()),
               unit.unit().firmware().arming().armed() ? "ARMED   " : "disarmed", -truth.p_NB_N.z(),
               static_cast<unsigned long long>(unit.served().bytes_given() / 1000),
               static_cast<unsigned long long>(unit.served().bytes_taken() / 1000),
               lost > Time::zero() ? "  (this machine is too slow)" : "");
}

LoadedScenario load(const ServeArguments& arguments, const autopilot::Modules& modules) {
  LoadedScenario loaded =
      load_scenario(arguments.scenario, {split_settings(arguments.settings), std::nullopt}, modules);
  if (arguments.idle_pilot) loaded.scenario.pilot.automatic = false;
  if (arguments.on_desk) loaded.scenario.fcu.on_desk = true;
  return loaded;
}

/// The unit's clock, as far as this machine keeps up with it.
class UnitClock {
 public:
  explicit UnitClock(Time period) : period_(period) {}

  /// Until the next tick.
  void wait() {
    next_ += period_;
    const Time behind = machine_time() - next_;
    if (behind > kGivenUp) {
      lost_ += behind;
      next_ += behind;
    }
    // A unit that is always late would never leave the core: it runs before all ordinary programs.
    hil_bridge::transport::sleep_until(std::max(next_, machine_time() + period_ / kLeastRest));
  }
  Time lost() const { return lost_; }

 private:
  Time period_;
  Time next_ = machine_time();
  Time lost_{};
};

int serve(const ServeArguments& arguments, const autopilot::Modules& modules) {
  note_interrupts();
  const LoadedScenario loaded = load(arguments, modules);
  const std::unique_ptr<SocketCan> bus = open_bus(arguments);
  ServedLine line(arguments, loaded);
  ServedUnit unit(loaded.scenario, line.stream(), bus.get());
  std::fprintf(stderr, "serving %s; connect with: ironbird fcu info %s; Ctrl-C ends\n",
               loaded.scenario.vehicle_folder.c_str(), line.how_to_reach().c_str());
  // A board has its processor for itself.
  if (const std::string missing = hil_bridge::take_real_time_rights(); !missing.empty()) {
    std::fprintf(stderr, "%s\n", missing.c_str());
  }
  const bool interactive = Terminal::of_standard_error().interactive;
  const Time end = from_seconds(arguments.duration);
  UnitClock clock(Time(std::llround(static_cast<double>(unit.period().count()) / arguments.time_scale)));
  Time told{};
  while (!interrupt_requested() && (end == Time::zero() || unit.now() < end)) {
    line.advance(unit.now());
    unit.tick();
    line.advance(unit.now());
    tell_events(bus.get(), arguments.can);
    if (interactive && unit.now() - told >= kServeTellPeriod) {
      tell(unit, clock.lost());
      told = unit.now();
    }
    clock.wait();
  }
  if (interactive) std::fputs("\n", stderr);
  if (clock.lost() == Time::zero()) return kExitPass;
  std::fprintf(stderr, "this machine was too slow: the unit's time fell %.1f s behind\n",
               to_seconds(clock.lost()));
  return kExitInconclusive;
}

}  // namespace

FcuWork declare_fcu_serve(VerbOptions& options) {
  auto arguments = std::make_shared<ServeArguments>();
  options.option("scenario", arguments->scenario, "vehicle, world, parameters and pilot of the unit")
      .required();
  options.option("--set", arguments->settings, "changes the scenario; may be repeated")
      .one_word_each()
      .called("PATH=VALUE");
  options.option("--pty", arguments->pty, "make a pseudo-terminal and this link to it");
  options.option("--udp", arguments->udp, "have this UDP port, and send to --udp-to").within(1, 65535);
  options.option(
      "--udp-to", arguments->udp_to,
      "with --udp: where the companion is, HOST[:PORT]; else localhost, and its usual port is 14520");
  options.option("--duration", arguments->duration, "end after so many seconds").within(0.1, 86400.0);
  options.option("--can", arguments->can, "its motors are on this CAN interface, as DroneCAN controllers");
  options.flag("--can-fd", arguments->can_fd, "in CAN FD frames");
  options.flag("--on-desk", arguments->on_desk, "its own vehicle stands still whatever its outputs are");
  options.option("--time-scale", arguments->time_scale, "its seconds in a second of the clock")
      .within(0.001, 1.0);
  options.flag("--idle-pilot", arguments->idle_pilot,
               "the pilot leaves the switches alone: it is never armed");
  options.footer(
      "A virtual unit that others meet as they would meet a real one, in real time: streams and rates, "
      "texts, parameters,\n"
      "and the firmware's oddities. The pilot of the scenario arms when somebody has been there for "
      "`pilot.arm_at`.\n"
      "Examples:\n"
      "  ironbird fcu serve scenarios/library/paper/three_waypoints.toml --pty /tmp/unit\n"
      "  ironbird fcu serve scenarios/library/paper/three_waypoints.toml --udp 14525\n"
      "  ironbird fcu serve scenarios/library/paper/three_waypoints.toml --pty /tmp/unit --can vcan0 "
      "--on-desk");
  return [arguments](const autopilot::Modules& modules) { return serve(*arguments, modules); };
}

}  // namespace ironbird::scenarios
