#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "hil_bridge/can/dronecan_messages.hpp"
#include "hil_bridge/can/dynamic_node_id.hpp"
#include "hil_bridge/can/esc_parameters.hpp"
#include "hil_bridge/can/node_port.hpp"

namespace ironbird::hil_bridge::can {

/// One motor controller as it comes out of the box.
struct EscNodeParams {
  int node = 20;
  int esc_index = 0;
  int status_rate = 50;
  double command_timeout = 0.1;
  bool require_arming = true;
  bool fd = false;
  std::string name = "org.ironbird.esc";

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("node", self.node, "1", "number on the bus, 0 to ask for one", 0, 127);
    visit("esc_index", self.esc_index, "1", "place in the command", 0, 19);
    visit("status_rate", self.status_rate, "Hz", "reports a second", 10, 50);
    visit("command_timeout", self.command_timeout, "s", "a command older than this stops the motor", 0.02,
          1.0);
    visit("require_arming", self.require_arming, "1", "turns only while it hears that the vehicle is armed");
    visit("fd", self.fd, "1", "reports in CAN FD frames");
    visit("name", self.name, "", "what it calls itself");
  }
};

/// What an ESC would measure, taken from the simulated rotor.
struct EscReading {
  double speed = 0.0;
  double voltage = 0.0;
  double current = 0.0;
  double temperature = 293.15;
  std::uint32_t errors = 0;
  NodeHealth health = kHealthOk;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("speed", self.speed, "rad/s", "of the rotor, positive when it lifts");
    visit("voltage", self.voltage, "V", "of the supply");
    visit("current", self.current, "A", "from the supply");
    visit("temperature", self.temperature, "K", "of the ESC");
    visit("errors", self.errors, "1", "since it started");
    visit("health", self.health, "1", "0 ok, 1 warning, 2 error, 3 critical");
  }
};

/// Why a motor does what it does.
enum class EscCondition : std::uint8_t { kRunning, kNeverCommanded, kStale, kDisarmed };

constexpr std::array<std::pair<EscCondition, std::string_view>, 4> enumerators(EscCondition) {
  return {{{EscCondition::kRunning, "running"},
           {EscCondition::kNeverCommanded, "never_commanded"},
           {EscCondition::kStale, "stale"},
           {EscCondition::kDisarmed, "disarmed"}}};
}

struct EscCommand {
  double throttle = 0.0;
  EscCondition condition = EscCondition::kNeverCommanded;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("throttle", self.throttle, "1", "0 stopped to 1 all forward");
    visit("condition", self.condition, "1",
          "0 follows its command, 1 never had one, 2 command too old, 3 disarmed");
  }
};

/// Plays one ESC on the bus: takes RawCommand and ArmingStatus, reports itself, answers questions. A pure
/// stepping object. Has no motor: whoever steps it turns the simulated rotor by its command and hands in the
/// readings.
///
/// Is not reversible: a negative command stops it. While it has no number it asks for one and takes no
/// commands.
class EscNode {
 public:
  /// How long the word that the vehicle is armed is good for: four times the period at which controllers say
  /// it.
  static constexpr Time kArmingTimeout = std::chrono::seconds(2);

  /// @throws std::invalid_argument when a parameter is outside its bounds.
  EscNode(const EscNodeParams& params, Time start);

  void take(const ReceivedFrame& frame, Time now);

  /// Sends what is due. Call it at least as often as statuses are to be sent.
  void step(const EscReading& reading, Time now, transport::FrameBus& bus);

  /// What the motor has to do now. Zero unless the last command is fresh and the vehicle armed.
  EscCommand command(Time now) const;

  const EscParameters& parameters() const { return parameters_; }
  const NodePort& port() const { return port_; }

 private:
  void ask_for_number(Time now);
  void take_allocation(const ReceivedTransfer& transfer, Time now);
  void answer(const ReceivedTransfer& request, Time now);
  GetNodeInfoResponse info(Time now) const;
  NodeStatus status(Time now) const;
  EscStatus report(const EscReading& reading, Time now) const;
  void restart(Time now);

  std::string name_;
  UniqueId unique_id_;
  NodePort port_;
  std::optional<NodeIdClient> asking_;
  EscParameters parameters_;
  Time start_;
  Time next_status_;
  Time next_report_;
  Time commanded_at_{};
  Time armed_at_{};
  double throttle_ = 0.0;
  NodeHealth health_ = kHealthOk;
  bool commanded_ = false;
  bool arming_heard_ = false;
  bool armed_ = false;
};

}  // namespace ironbird::hil_bridge::can
