#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "autopilot/modules.hpp"
#include "hil_bridge/transport/link_fault.hpp"
#include "hil_bridge/transport/stream_pair.hpp"
#include "hil_bridge/virtual_fcu/served_fcu.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"
#include "scenarios/bench/live_bench.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/bench/world_maker.hpp"

// A served unit with its world and its pilot at one end of a line, the bench of real runs at the other, and a
// clock that the test owns: real time without waiting.

namespace ironbird::scenarios::test {

using hil_bridge::Arrival;
using hil_bridge::Time;
namespace rosflight = hil_bridge::rosflight;

/// A unit that can be kept from saying some things.
class MutableUnit final : public hil_bridge::Fcu {
 public:
  explicit MutableUnit(hil_bridge::Fcu& unit) : unit_(&unit) {}
  void advance(Time now) override { unit_->advance(now); }
  void receive(std::vector<Arrival>& out) override {
    said_.clear();
    unit_->receive(said_);
    for (const Arrival& arrival : said_) {
      if (!muted.contains(arrival.message.index())) out.push_back(arrival);
    }
  }
  void send(const rosflight::Message& message) override {
    if (const auto* command = std::get_if<rosflight::OffboardControl>(&message)) {
      ++commands;
      last_command = *command;
      greatest_force = std::max(greatest_force, -command->u[2]);
    }
    unit_->send(message);
  }

  template <class Content>
  void mute() {
    muted.insert(rosflight::Message(Content{}).index());
  }

  /// It is another one from now on.
  void become(hil_bridge::Fcu& unit) { unit_ = &unit; }

  std::set<std::size_t> muted;
  int commands = 0;
  rosflight::OffboardControl last_command;
  float greatest_force = 0.0F;

 private:
  hil_bridge::Fcu* unit_;
  std::vector<Arrival> said_;
};

/// The firmware of a unit that has just booted in the middle of a flight: its clock begins, the world goes
/// on.
class BootedUnit final : public hil_bridge::Fcu {
 public:
  BootedUnit(const hil_bridge::VirtualFcuConfig& config, simulator::World& world, Time booted)
      : world_(world), tick_(config.tick), booted_(booted), host_(config) {}

  void advance(Time now) override {
    for (Time own = host_.now() + tick_; booted_ + own <= now; own += tick_) {
      world_.set_armed(host_.firmware().arming().armed());
      world_.step(host_.commands(), booted_ + own);
      simulator::Readings readings = world_.readings();
      if (readings.imu) readings.imu->taken = own;
      if (readings.gnss) readings.gnss->taken = own;
      host_.tick(readings, own);
    }
  }
  void receive(std::vector<Arrival>& out) override {
    host_.receive(out);
    for (Arrival& arrival : out) arrival.when = booted_ + host_.now();
  }
  void send(const rosflight::Message& message) override { host_.send(message); }
  hil_bridge::FirmwareHost& host() { return host_; }

 private:
  simulator::World& world_;
  Time tick_;
  Time booted_;
  hil_bridge::FirmwareHost host_;
};

/// The other end of the line, as a clock: who waits lets the unit live until it says something.
class UnitEnd final : public hil_bridge::Clock {
 public:
  UnitEnd(const Scenario& scenario, hil_bridge::transport::ByteStream& line)
      : scenario_(scenario),
        world_(make_world(scenario)),
        fcu_(scenario.fcu, *world_),
        unit_(fcu_),
        served_(unit_, line) {}

  Time now() override { return now_; }
  void wait(int, Time until) override {
    if (stalled > Time::zero()) {  // the bench is not scheduled
      const Time end = now_ + std::exchange(stalled, Time::zero());
      while (next_tick() <= end) live_to(next_tick());
      now_ = end;
    } else if (next_tick() <= until) {
      live_to(next_tick());
    } else {
      now_ = until;
    }
  }

  /// The unit boots, and finds the pilot's switches as they are: armed, and handed over.
  BootedUnit& boot() {
    hil_bridge::VirtualFcuConfig config = scenario_.fcu;
    config.calibrate_imu_at_start = false;
    for (const char* const kept : {"ACC_X_BIAS", "ACC_Y_BIAS", "ACC_Z_BIAS"}) {  // in its flash
      const auto bias = fcu_.firmware().parameters().real(hil_bridge::virtual_fcu::find_parameter(kept));
      config.parameters.push_back({kept, static_cast<double>(bias)});
    }
    booted_ = std::make_unique<BootedUnit>(config, *world_, ticked_);
    booted_->host().pilot().arm(true);
    booted_->host().pilot().override_companion(false);
    unit_.become(*booted_);
    return *booted_;
  }

  /// Of the unit that there is now.
  const hil_bridge::virtual_fcu::Firmware& firmware() {
    return booted_ ? booted_->host().firmware() : fcu_.firmware();
  }

  MutableUnit& unit() { return unit_; }
  hil_bridge::VirtualFcu& fcu() { return fcu_; }
  const simulator::World& world() const { return *world_; }
  Time stalled{};  ///< how long the next wait lasts, whatever comes
  Time arm_at = std::chrono::seconds(5);
  bool hands_over = true;

 private:
  static constexpr Time kHandOver = std::chrono::milliseconds(500);
  Time next_tick() const { return ticked_ + scenario_.fcu.tick; }
  void live_to(Time when) {
    now_ = ticked_ = when;
    served_.take();
    if (when >= arm_at && !armed_) fcu_.pilot().arm(armed_ = true);
    if (hands_over && when >= arm_at + kHandOver) fcu_.pilot().override_companion(false);
    unit_.advance(when);
    served_.give();
  }

  const Scenario& scenario_;
  std::unique_ptr<simulator::World> world_;
  hil_bridge::VirtualFcu fcu_;
  std::unique_ptr<BootedUnit> booted_;
  MutableUnit unit_;
  hil_bridge::ServedFcu served_;
  Time now_{};
  Time ticked_{};
  bool armed_ = false;
};

/// Both ends, ready to fly a scenario.
class LiveRig {
 public:
  using Settings = std::vector<std::pair<std::string, std::string>>;

  explicit LiveRig(Settings settings = {}, const std::string& scenario = "paper/three_waypoints") {
    settings.insert(settings.begin(), {{"fcu.kind", "serial"}, {"fcu.line", "/dev/none"}});
    loaded =
        load_scenario(std::filesystem::path(IRONBIRD_SOURCE_DIR) / "scenarios/library" / (scenario + ".toml"),
                      {settings, std::nullopt}, modules);
    unit_scenario = loaded.scenario;
    options.released = true;
  }

  /// The ends are made on first use, so that a test may change scenario and options before.
  UnitEnd& there() {
    if (!there_) there_ = std::make_unique<UnitEnd>(unit_scenario, line.far());
    return *there_;
  }
  LiveBench& bench() {
    if (!bench_) bench_ = std::make_unique<LiveBench>(loaded, modules, options, line.near(), there());
    return *bench_;
  }

  hil_bridge::InterlockState state() { return bench().interlock().state; }
  /// Passes until `holds`, for at most so long. @return does it hold?
  bool until(double seconds, const std::function<bool()>& holds) {
    const Time end = there().now() + from_seconds(seconds);
    while (!holds()) {
      if (there().now() >= end || bench().ended()) return holds();
      bench().pass();
    }
    return true;
  }
  /// The same, whether or not the run is over.
  bool pass_for(Time span, const std::function<bool()>& holds) {
    const Time end = there().now() + span;
    while (!holds() && there().now() < end) bench().pass();
    return holds();
  }
  bool live_within(double seconds) {
    return until(seconds, [this] { return state() == hil_bridge::InterlockState::kLive; });
  }
  bool flies_within(double seconds) {
    return until(seconds, [this] { return there().world().truth().p_NB_N.z() < -1.0; });
  }

  const autopilot::Modules modules = autopilot::standard_modules();
  LoadedScenario loaded;
  Scenario unit_scenario;
  LiveOptions options;
  hil_bridge::transport::StreamPair line;

 private:
  std::unique_ptr<UnitEnd> there_;
  std::unique_ptr<LiveBench> bench_;
};

}  // namespace ironbird::scenarios::test
