#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hil_bridge/can/dronecan_messages.hpp"
#include "hil_bridge/can/dynamic_node_id.hpp"
#include "hil_bridge/can/node_port.hpp"

namespace ironbird::hil_bridge::can {

/// The bench as the controller of ESCs.
struct EscControllerParams {
  int node = 10;
  int count = 4;
  bool fd = false;
  bool grant_numbers = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("node", self.node, "1", "number on the bus", 1, 127);
    visit("count", self.count, "1", "motors", 1, 20);
    visit("fd", self.fd, "1", "sends CAN FD frames");
    visit("grant_numbers", self.grant_numbers, "1", "gives numbers to nodes that ask; only one on a bus may");
  }
};

/// What is known of another node.
struct NodeRecord {
  NodeStatus status;
  Time heard{};
  Time asked{};
  bool known = false;
  bool named = false;
  std::uint32_t restarts = 0;
  BoundedText<80> name;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("status", self.status, "", "its last sign of life");
    visit("heard", self.heard, "ns", "when that came");
    visit("asked", self.asked, "ns", "when it was asked for its name");
    visit("known", self.known, "1", "heard at least once");
    visit("named", self.named, "1", "it said its name");
    visit("restarts", self.restarts, "1", "how often its uptime went backwards");
    visit("name", self.name, "", "what it calls itself");
  }
};

/// What is known of one motor.
struct EscRecord {
  EscStatus status;
  Time heard{};
  std::uint8_t node = 0;
  std::uint32_t conflicts = 0;
  Time contested{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("status", self.status, "", "its last report");
    visit("heard", self.heard, "ns", "when that came");
    visit("node", self.node, "1", "who reported, 0 nobody yet");
    visit("conflicts", self.conflicts, "1", "reports that came while another node claimed to be this motor");
    visit("contested", self.contested, "ns", "when the last of these came");
  }
};

/// Drives ESCs on a stand: commands out, reports in, an eye on every node. Commands are zero until it is
/// armed, and when one of them is no number from 0 to 1.
///
/// It is no safety device. What reaches it has to have passed the bench's interlock, and real ESCs stop by
/// themselves when commands stop.
class EscController {
 public:
  static constexpr Time kNodeTimeout = std::chrono::seconds(3);
  /// As flight controllers have it.
  static constexpr Time kReportTimeout = std::chrono::milliseconds(1200);
  /// A command that did not get out by then is dropped.
  static constexpr Time kCommandLifetime = std::chrono::milliseconds(5);

  /// @throws std::invalid_argument when a parameter is outside its bounds.
  /// @param bus  has to outlive this
  EscController(const EscControllerParams& params, transport::FrameBus& bus, Time start);

  void set_armed(bool armed);

  /// Sends one command for all motors, at once.
  /// @param throttles  0 to 1, one for each motor
  /// @return false when zeros were sent instead: a throttle is no number from 0 to 1, or there are too few or
  /// too many
  bool command(std::span<const double> throttles, Time now);

  /// Takes what arrived and sends what is due. Call it at least ten times a second.
  void step(Time now);

  /// The node was heard within three seconds.
  bool node_alive(std::uint8_t node, Time now) const;
  /// The motor's node lives, does not complain, and reported within 1.2 seconds, and no other claims to be
  /// it.
  bool motor_ready(std::size_t motor, Time now) const;

  const EscRecord& motor(std::size_t motor) const { return motors_[motor]; }
  const NodeRecord& node(std::uint8_t node) const { return nodes_[node & 0x7FU]; }

 private:
  void take(const ReceivedTransfer& transfer, Time stamp);
  void take_wish(const Allocation& wish, Time now);
  void take_status(std::uint8_t source, const NodeStatus& status, Time stamp);
  void take_report(std::uint8_t source, const EscStatus& status, Time stamp);
  void ask_names(Time now);

  transport::FrameBus& bus_;
  NodePort port_;
  std::optional<NodeIdServer> numbers_;
  std::array<NodeRecord, kGreatestNode + 1> nodes_{};
  std::vector<EscRecord> motors_;
  Time start_;
  Time next_status_;
  Time next_arming_;
  bool armed_ = false;
};

}  // namespace ironbird::hil_bridge::can
