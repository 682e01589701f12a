#include <poll.h>

#include <algorithm>
#include <array>
#include <deque>
#include <span>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/real_time_rights.hpp"
#include "hil_bridge/interlock/command_check.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"
#include "hil_bridge/serial_fcu/serial_fcu.hpp"
#include "hil_bridge/translate/command_encoder.hpp"
#include "hil_bridge/translate/sensor_frame_builder.hpp"
#include "hil_bridge/transport/awake_cores.hpp"
#include "hil_bridge/transport/machine_clock.hpp"
#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "hil_bridge/transport/serial_port.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/fcu/latency.hpp"
#include "scenarios/fcu/serve.hpp"
#include "scenarios/fcu/side_process.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;
using hil_bridge::transport::ByteStream;
using hil_bridge::transport::machine_time;
using hil_bridge::transport::PseudoTerminal;
namespace rosflight = hil_bridge::rosflight;

constexpr int kCommandPatience = 100;  // ms
constexpr int kAnyBaud = 921600;

/// The unit's end of the line: notes when it began to write in this tick, and reads ahead until a motor
/// command has come.
class StampedLine final : public ByteStream {
 public:
  explicit StampedLine(PseudoTerminal& line) : line_(line) {}

  /// Waits for a motor command. @return when it was there, or nothing in a tenth of a second
  std::optional<Time> await_command() {
    const Time end = machine_time() + std::chrono::milliseconds(kCommandPatience);
    while (machine_time() < end) {
      pollfd state{line_.descriptor(), POLLIN, 0};
      if (poll(&state, 1, kCommandPatience) <= 0) break;
      const Time there = machine_time();
      if (read_ahead()) return there;
    }
    return std::nullopt;
  }
  void begin_tick() { written_.reset(); }
  std::optional<Time> written() const { return written_; }

  std::size_t read(std::span<std::uint8_t> to) override {
    if (ahead_.empty()) read_ahead();
    const std::size_t count = std::min(to.size(), ahead_.size());
    std::copy_n(ahead_.begin(), count, to.begin());
    ahead_.erase(ahead_.begin(), ahead_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  std::size_t write(std::span<const std::uint8_t> from) override {
    if (!written_) written_ = machine_time();
    return line_.write(from);
  }
  bool is_up() const override { return line_.is_up(); }
  bool reopen() override { return line_.reopen(); }
  int descriptor() const override { return line_.descriptor(); }
  std::string name() const override { return line_.name(); }

 private:
  bool read_ahead() {
    std::array<std::uint8_t, 4096> bytes{};
    const std::size_t count = line_.read(bytes);
    bool command = false;
    decoder_.push(std::span(bytes).first(count), [&](const rosflight::Frame& frame) {
      command = command || std::holds_alternative<rosflight::OffboardControl>(frame.message);
    });
    ahead_.insert(ahead_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    return command;
  }

  PseudoTerminal& line_;
  rosflight::StreamDecoder decoder_;
  std::deque<std::uint8_t> ahead_;
  std::optional<Time> written_;
};

/// The unit's process: a tick, then the wait for the command that answers it.
void serve(const Scenario& scenario, PseudoTerminal& terminal, SharedTimes& round_trips) {
  hil_bridge::take_real_time_rights();
  StampedLine line(terminal);
  ServedUnit unit(scenario, line);
  for (Time next = machine_time();; next = std::max(next + unit.period(), machine_time())) {
    hil_bridge::transport::sleep_until(next);
    line.begin_tick();
    unit.tick();
    if (!line.written()) continue;
    const auto answered = line.await_command();
    if (answered) round_trips.add(*answered - *line.written());
  }
}

/// The bench's side, as a real run has it, without a log.
class Answerer {
 public:
  Answerer(const std::string& device, const LoadedScenario& loaded, const autopilot::Modules& modules)
      : port_({device, kAnyBaud}), fcu_(port_, {}, &gate_), pilot_(loaded.autopilot, modules) {
    port_.open();
  }

  void look() {
    pollfd state{port_.descriptor(), POLLIN, 0};
    if (poll(&state, 1, kCommandPatience) <= 0) return;
    const Time woken = machine_time();
    fcu_.advance(woken);
    heard_.clear();
    fcu_.receive(heard_);
    for (const hil_bridge::Arrival& arrival : heard_) {
      const autopilot::SensorFrame* const frame = builder_.push(arrival);
      if (frame == nullptr) continue;
      // On the ground the autopilot may have nothing to say; the way is the same.
      fcu_.send(hil_bridge::encode(pilot_.step(*frame)).value_or(hil_bridge::zero_command()));
      turn_around.push_back(machine_time() - woken);
    }
  }

  std::vector<Time> turn_around;

 private:
  hil_bridge::transport::SerialPort port_;
  hil_bridge::SimulatedUnitGate gate_;
  hil_bridge::SerialFcu fcu_;
  autopilot::Autopilot pilot_;
  hil_bridge::SensorFrameBuilder builder_;
  std::vector<hil_bridge::Arrival> heard_;
};

}  // namespace

LatencyReport latency_of_self(const std::string& file, double seconds, const autopilot::Modules& modules) {
  LoadedScenario loaded = load_scenario(file, {}, modules);
  loaded.scenario.pilot.automatic = false;
  PseudoTerminal terminal;
  SharedTimes round_trips(kHourOfWakings);
  SharedTimes late(kHourOfWakings);
  Answerer answerer(terminal.device(), loaded, modules);
  const hil_bridge::transport::AwakeCores awake;
  const SideProcess unit([&] { serve(loaded.scenario, terminal, round_trips); });
  const SideProcess sleeper([&] { measure_jitter(late); });
  LatencyReport report;
  report.missing = take_rights_of_a_run(awake);
  const Time end = machine_time() + from_seconds(seconds);
  while (machine_time() < end && !interrupt_requested()) answerer.look();
  report.where = "a pseudo-terminal of this machine, unit of " + loaded.name;
  report.round_trip_meaning = "IMU frame leaves the unit to command frame there, autopilot included";
  report.round_trip = Spread(round_trips.all());
  report.turn_around_meaning = "woken by an IMU frame to the command handed to the line";
  report.turn_around = Spread(answerer.turn_around);
  report.jitter = Spread(late.all());
  return report;
}

}  // namespace ironbird::scenarios
