#include "scenarios/fcu/unit_line.hpp"

#include <poll.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "hil_bridge/transport/machine_clock.hpp"
#include "hil_bridge/transport/serial_port.hpp"
#include "hil_bridge/transport/udp_socket.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/meeting.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {

using hil_bridge::ConnectionState;
using hil_bridge::transport::ByteStream;
using hil_bridge::transport::LinkError;
using hil_bridge::transport::SerialPort;
using hil_bridge::transport::UdpSocket;

namespace {

constexpr double kFlashPatience = 60.0;  // s
constexpr int kLook = 2;                 // ms between looks at a line on which nothing happens

}  // namespace

void add_unit_address(VerbOptions& options, UnitAddress& address) {
  options.option("--port,--line", address.port, "serial port of the unit, as /dev/ttyACM0");
  options.option("--baud", address.baud, "rate of the port, Bd").shows_default();
  options.option("--udp", address.udp,
                 "unit behind UDP instead, HOST[:PORT[:OWN_PORT]]; the usual ports are 14525 and 14520");
  options.option("--patience", address.patience, "how long to wait for the unit, s")
      .shows_default()
      .within(0.1, 3600.0);
}

std::unique_ptr<ByteStream> open_line(const UnitAddress& address) {
  if (address.port.empty() == address.udp.empty()) {
    throw ConfigError("say where the unit is: either --port DEVICE or --udp HOST[:PORT]");
  }
  if (!address.udp.empty()) {
    const auto peer = hil_bridge::transport::udp_peer(address.udp);
    if (!peer) {
      throw ConfigError("--udp = " + address.udp +
                        ": must be HOST, HOST:PORT or HOST:PORT:OWN_PORT, for example localhost:14525");
    }
    auto socket = std::make_unique<UdpSocket>(*peer);
    socket->open();
    return socket;
  }
  auto port =
      std::make_unique<SerialPort>(hil_bridge::transport::SerialPortConfig{address.port, address.baud});
  port->open();
  return port;
}

std::string why_not_kept(hil_bridge::ParameterOutcome outcome) {
  if (outcome == hil_bridge::ParameterOutcome::kRefused) {
    return "the unit refused to write them to its flash; it does while it is armed, and when the flash does "
           "not "
           "take them. `ironbird fcu monitor` shows its state and its texts";
  }
  return "the unit did not confirm that it wrote them to flash; try again with --keep";
}

UnitOnLine::UnitOnLine(const UnitAddress& address, Talk talk)
    : address_(address),
      line_(open_line(address)),
      gate_({}),
      fcu_(*line_, {}, talk == Talk::kChanges ? &gate_ : nullptr) {}

hil_bridge::Time UnitOnLine::now() const {
  return hil_bridge::transport::machine_time();
}

void UnitOnLine::step() {
  const hil_bridge::Time time = now();
  const hil_bridge::Connection& connection = fcu_.connection();
  hil_bridge::InterlockInputs in;
  in.unit_armed = connection.armed(time);
  in.unit_disarmed = connection.disarmed(time);
  gate_.step(in, time);
  fcu_.advance(time);
  heard_.clear();
  fcu_.receive(heard_);
  if (!ear_) return;
  for (const hil_bridge::Arrival& arrival : heard_) ear_(arrival);
}

bool UnitOnLine::until(double seconds, const std::function<bool()>& done) {
  const auto end = now() + from_seconds(seconds);
  for (;;) {
    step();
    if (done()) return true;
    if (now() >= end || interrupt_requested()) return false;
    pollfd state{line_->descriptor(), POLLIN, 0};
    poll(&state, 1, kLook);
  }
}

void UnitOnLine::meet() {
  const hil_bridge::Connection& connection = fcu_.connection();
  const bool met = until(address_.patience, [&] {
    // An armed unit does not tell its version, but may be looked at.
    const bool armed = connection.armed(now()) && connection.parameters().progress().complete;
    return armed || connection.state() == ConnectionState::kReady ||
           connection.state() == ConnectionState::kRefused;
  });
  const std::string where = line_->name() + ": ";
  if (connection.state() == ConnectionState::kRefused) throw LinkError(where + connection.refusal());
  if (met) return;
  throw LinkError(where + why_not_met(fcu_, now(), address_.patience));
}

bool UnitOnLine::keep() {
  hil_bridge::ParameterClient& client = connection().parameters();
  client.write_to_flash();
  until(kFlashPatience, [&] { return client.write_outcome() != hil_bridge::ParameterOutcome::kPending; });
  if (client.write_outcome() == hil_bridge::ParameterOutcome::kDone) return true;
  std::fprintf(stderr, "the values are set, but not kept: %s\n",
               why_not_kept(client.write_outcome()).c_str());
  return false;
}

}  // namespace ironbird::scenarios
