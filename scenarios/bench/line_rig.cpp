#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "hil_bridge/executive/pace.hpp"
#include "hil_bridge/hil_fcu/stand_unit.hpp"
#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/transport/machine_clock.hpp"
#include "hil_bridge/transport/serial_port.hpp"
#include "hil_bridge/transport/socket_can.hpp"
#include "hil_bridge/transport/udp_socket.hpp"
#include "scenarios/bench/hil_rig.hpp"
#include "scenarios/bench/make_guard.hpp"

// A unit at the other end of a line, and the bus of its motors on an interface of this machine.

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;
using namespace hil_bridge::transport;

// Of the run's time. The unit's own time-out has long given the vehicle to the pilot.
constexpr Time kLongestPause = std::chrono::milliseconds(500);

std::unique_ptr<ByteStream> open_line(const FcuConfig& fcu) {
  if (fcu.line.starts_with(kUdp)) {
    const auto peer = udp_peer(std::string_view(fcu.line).substr(kUdp.size()));
    if (!peer) {
      throw std::invalid_argument(
          "fcu.line = " + fcu.line +
          ": must be udp:HOST, udp:HOST:PORT or udp:HOST:PORT:OWN_PORT, for example udp:localhost:14525");
    }
    auto socket = std::make_unique<UdpSocket>(*peer);
    socket->open();
    return socket;
  }
  auto port = std::make_unique<SerialPort>(SerialPortConfig{fcu.line, fcu.baud});
  port->open();
  return port;
}

/// @param where  can:INTERFACE
std::unique_ptr<SocketCan> open_bus(const std::string& where, bool fd) {
  SocketCanParams params;
  params.interface = where.substr(kCanInterface.size());
  params.fd = fd;
  try {
    return std::make_unique<SocketCan>(params, machine_time());
  } catch (const std::invalid_argument& error) {
    throw LinkError(error.what());
  }
}

/// The unit, and its line's faults at their time.
class LineEnd final : public hil_bridge::Fcu {
 public:
  LineEnd(hil_bridge::SerialFcu& serial, LinkFault* faults) : serial_(serial), faults_(faults) {}
  void advance(Time now) override {
    if (faults_ != nullptr) faults_->advance(now);
    serial_.advance(now);
  }
  void receive(std::vector<hil_bridge::Arrival>& out) override { serial_.receive(out); }
  void send(const hil_bridge::rosflight::Message& message) override { serial_.send(message); }

 private:
  hil_bridge::SerialFcu& serial_;
  LinkFault* faults_;
};

class LineRig final : public HilRig {
 public:
  LineRig(const Scenario& scenario, simulator::World& world, bool faults)
      : line_(open_line(scenario.fcu)),
        line_fault_(faults ? std::make_unique<LinkFault>(*line_, scenario.fcu.link_fault, scenario.seed,
                                                         &hil_bridge::rosflight::piece_length)
                           : nullptr),
        serial_(line_fault_ ? static_cast<ByteStream&>(*line_fault_) : *line_,
                {.system = static_cast<std::uint8_t>(unit_parameter(scenario, "SYS_ID"))}),
        end_(serial_, line_fault_.get()),
        pace_(scenario.fcu.time_scale) {
    if (scenario.fcu.motors != kOutputRaw) wire_bus(scenario, faults);
    if (!scenario.fcu.stand.empty()) wire_stand(scenario);
    hil_bridge::Fcu& unit = stand_ ? static_cast<hil_bridge::Fcu&>(*stand_) : end_;
    hil_.emplace(scenario.fcu, world, unit, motors(), scenario.fcu.external_attitude);
  }

  hil_bridge::Fcu& fcu() override { return *hil_; }
  const hil_bridge::SerialFcu& serial() const override { return serial_; }
  void set_gate(hil_bridge::Gate& gate) override { serial_.set_gate(gate); }
  hil_bridge::RcPilot* pilot() override { return nullptr; }
  LinkFault* line_faults() override { return line_fault_.get(); }
  BusFault* bus_faults() override { return bus_fault_ ? &*bus_fault_ : nullptr; }
  hil_bridge::CanMotors* motors() override { return motors_ ? &*motors_ : nullptr; }
  void open_stand(const hil_bridge::InterlockStatus& gate) override {
    if (stand_) stand_->open(gate);
  }
  hil_bridge::StandMotors* stand() override { return stand_ ? stand_->motors() : nullptr; }
  bool wait_for(Time now) override { return pace_.wait(now) <= kLongestPause; }
  Time lost() const override { return pace_.lost(); }

 private:
  void wire_bus(const Scenario& scenario, bool faults) {
    bus_ = open_bus(scenario.fcu.motors, scenario.fcu.can_fd);
    if (faults) bus_fault_.emplace(*bus_, scenario.fcu.bus_fault, scenario.seed);
    FrameBus& end = bus_fault_ ? static_cast<FrameBus&>(*bus_fault_) : *bus_;
    motors_.emplace(played_escs(scenario), scenario.vehicle.rotor, end, Time{0}, bus_faults());
  }

  void wire_stand(const Scenario& scenario) {
    bus_ = open_bus(scenario.fcu.stand, scenario.fcu.can_fd);
    hil_bridge::can::EscControllerParams params;
    params.count = static_cast<int>(scenario.vehicle.rotors.size());
    params.fd = scenario.fcu.can_fd;
    stand_.emplace(end_, params, *bus_);
  }

  std::unique_ptr<ByteStream> line_;
  std::unique_ptr<LinkFault> line_fault_;
  hil_bridge::SerialFcu serial_;
  LineEnd end_;
  std::unique_ptr<SocketCan> bus_;
  std::optional<BusFault> bus_fault_;
  std::optional<hil_bridge::CanMotors> motors_;
  std::optional<hil_bridge::StandUnit> stand_;
  std::optional<hil_bridge::HilFcu> hil_;
  hil_bridge::Pace pace_;
};

}  // namespace

std::unique_ptr<HilRig> make_line_rig(const Scenario& scenario, simulator::World& world, bool faults) {
  return std::make_unique<LineRig>(scenario, world, faults);
}

}  // namespace ironbird::scenarios
