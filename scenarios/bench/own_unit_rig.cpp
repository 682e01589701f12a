#include <optional>

#include "hil_bridge/serial_fcu/virtual_serial.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"
#include "hil_bridge/virtual_fcu/can_outputs.hpp"
#include "scenarios/bench/hil_rig.hpp"
#include "scenarios/bench/make_guard.hpp"
#include "scenarios/bench/world_maker.hpp"

// A virtual unit on a desk in this process, in lock-step.

namespace ironbird::scenarios {

namespace {

using hil_bridge::CanMotors;
using hil_bridge::CanOutputs;
using hil_bridge::Time;
using hil_bridge::VirtualFcu;
using hil_bridge::transport::BusFault;
using hil_bridge::transport::FrameBus;
using hil_bridge::transport::InProcessBus;

/// The same vehicle once more, on the desk; its sensors have noise of their own.
Scenario desk_scenario(const Scenario& scenario) {
  Scenario desk = scenario;
  desk.seed += 1;
  desk.fcu.on_desk = true;
  desk.start = {};
  return desk;
}

/// A virtual unit, and what its outputs do on a bus between two ticks.
class UnitWithBus final : public hil_bridge::Fcu {
 public:
  UnitWithBus(VirtualFcu& unit, CanOutputs* outputs, InProcessBus& bus, Time tick)
      : unit_(unit), outputs_(outputs), bus_(bus), tick_(tick) {}
  void advance(Time now) override {
    unit_.advance(now);
    if (outputs_ == nullptr) return;
    outputs_->step(unit_, now);
    bus_.advance(now + tick_);
  }
  void receive(std::vector<hil_bridge::Arrival>& out) override { unit_.receive(out); }
  void send(const hil_bridge::rosflight::Message& message) override { unit_.send(message); }

 private:
  VirtualFcu& unit_;
  CanOutputs* outputs_;
  InProcessBus& bus_;
  Time tick_;
};

hil_bridge::transport::InProcessBusParams bus_for(const Scenario& scenario) {
  hil_bridge::transport::InProcessBusParams params;
  params.fd = scenario.fcu.can_fd;
  return params;
}

hil_bridge::VirtualSerialConfig line_config(const Scenario& scenario, bool faults) {
  hil_bridge::VirtualSerialConfig config;
  config.system = static_cast<std::uint8_t>(unit_parameter(scenario, "SYS_ID"));
  if (faults) config.faults = scenario.fcu.link_fault;
  config.seed = scenario.seed;
  return config;
}

class OwnUnitRig final : public HilRig {
 public:
  OwnUnitRig(const Scenario& scenario, simulator::World& world, bool faults)
      : desk_(desk_scenario(scenario)),
        desk_world_(make_world(desk_)),
        unit_(desk_.fcu, *desk_world_),
        bus_(bus_for(scenario)) {
    if (scenario.fcu.motors != kOutputRaw) wire_bus(scenario, faults);
    with_bus_.emplace(unit_, outputs_ ? &*outputs_ : nullptr, bus_, scenario.fcu.tick);
    line_.emplace(*with_bus_, line_config(desk_, faults));
    hil_.emplace(scenario.fcu, world, *line_, motors(), scenario.fcu.external_attitude);
  }

  hil_bridge::Fcu& fcu() override { return *hil_; }
  const hil_bridge::SerialFcu& serial() const override { return line_->serial(); }
  void set_gate(hil_bridge::Gate& gate) override { line_->set_gate(gate); }
  hil_bridge::RcPilot* pilot() override { return &unit_.pilot(); }
  hil_bridge::transport::LinkFault* line_faults() override { return line_->faults(); }
  BusFault* bus_faults() override { return bus_fault_ ? &*bus_fault_ : nullptr; }
  CanMotors* motors() override { return motors_ ? &*motors_ : nullptr; }
  void open_stand(const hil_bridge::InterlockStatus&) override {}
  hil_bridge::StandMotors* stand() override { return nullptr; }
  bool wait_for(Time) override { return true; }
  Time lost() const override { return {}; }

 private:
  void wire_bus(const Scenario& scenario, bool faults) {
    FrameBus& bench_end = bus_.attach();
    outputs_.emplace(static_cast<int>(scenario.vehicle.rotors.size()), bus_.attach(), Time{0});
    if (faults) bus_fault_.emplace(bench_end, scenario.fcu.bus_fault, scenario.seed);
    FrameBus& end = bus_fault_ ? static_cast<FrameBus&>(*bus_fault_) : bench_end;
    motors_.emplace(played_escs(scenario), scenario.vehicle.rotor, end, Time{0}, bus_faults());
  }

  Scenario desk_;
  std::unique_ptr<simulator::World> desk_world_;
  VirtualFcu unit_;
  InProcessBus bus_;
  std::optional<CanOutputs> outputs_;
  std::optional<BusFault> bus_fault_;
  std::optional<CanMotors> motors_;
  std::optional<UnitWithBus> with_bus_;
  std::optional<hil_bridge::VirtualSerialFcu> line_;
  std::optional<hil_bridge::HilFcu> hil_;
};

}  // namespace

std::unique_ptr<HilRig> make_own_unit_rig(const Scenario& scenario, simulator::World& world, bool faults) {
  return std::make_unique<OwnUnitRig>(scenario, world, faults);
}

}  // namespace ironbird::scenarios
