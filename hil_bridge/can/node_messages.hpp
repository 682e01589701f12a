#pragma once

#include <array>
#include <cstdint>

#include "hil_bridge/can/serialisation.hpp"

// What every node has to say of itself. See dronecan_messages.hpp.

namespace ironbird::hil_bridge::can {

/// How a node feels.
enum NodeHealth : std::uint8_t { kHealthOk = 0, kHealthWarning = 1, kHealthError = 2, kHealthCritical = 3 };
/// What a node is doing.
enum NodeMode : std::uint8_t {
  kModeOperational = 0,
  kModeInitialising = 1,
  kModeMaintenance = 2,
  kModeUpdating = 3,
  kModeGoingOffline = 7
};

/// The sign of life that every node sends once a second.
struct NodeStatus {
  static constexpr DataType kType = {
      "uavcan.protocol.NodeStatus", {341, TransferKind::kMessage}, 0x0F0868D0C1A7C6F1};

  std::uint32_t uptime_sec{};
  std::uint8_t health{};
  std::uint8_t mode{};
  std::uint8_t sub_mode{};
  std::uint16_t vendor_specific_status_code{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("uptime_sec", self.uptime_sec, "s",
          "since the node started; backwards means that it started again");
    visit("health", self.health, "1", "0 ok, 1 warning, 2 error, 3 critical", Bits{2});
    visit("mode", self.mode, "1", "0 operational, 1 initialising, 2 maintenance, 3 updating, 7 going offline",
          Bits{3});
    visit("sub_mode", self.sub_mode, "1", "0", Bits{3});
    visit("vendor_specific_status_code", self.vendor_specific_status_code, "1", "the maker's");
  }
};

/// Which program a node runs.
struct SoftwareVersion {
  std::uint8_t major{};
  std::uint8_t minor{};
  std::uint8_t optional_field_flags{};
  std::uint32_t vcs_commit{};
  std::uint64_t image_crc{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("major", self.major, "1", "of the version");
    visit("minor", self.minor, "1", "of the version");
    visit("optional_field_flags", self.optional_field_flags, "1",
          "1 the commit counts, 2 the checksum counts");
    visit("vcs_commit", self.vcs_commit, "1", "beginning of the commit");
    visit("image_crc", self.image_crc, "1", "checksum of the program");
  }
};

/// On what board.
struct HardwareVersion {
  std::uint8_t major{};
  std::uint8_t minor{};
  std::array<std::uint8_t, 16> unique_id{};
  BoundedList<std::uint8_t, 255> certificate_of_authenticity{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("major", self.major, "1", "of the version");
    visit("minor", self.minor, "1", "of the version");
    visit("unique_id", self.unique_id, "1", "no other board has it");
    visit("certificate_of_authenticity", self.certificate_of_authenticity, "1", "usually empty");
  }
};

/// Who are you?
struct GetNodeInfoRequest {
  static constexpr DataType kType = {
      "uavcan.protocol.GetNodeInfo", {1, TransferKind::kRequest}, 0xEE468A8121C46A9E};

  template <class Self, class Visit>
  static constexpr void describe(Self&, Visit&&) {}
};

/// I am.
struct GetNodeInfoResponse {
  static constexpr DataType kType = {
      "uavcan.protocol.GetNodeInfo", {1, TransferKind::kResponse}, GetNodeInfoRequest::kType.signature};

  NodeStatus status{};
  SoftwareVersion software_version{};
  HardwareVersion hardware_version{};
  BoundedText<80> name{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("status", self.status, "", "as it is sent once a second");
    visit("software_version", self.software_version, "", "which program");
    visit("hardware_version", self.hardware_version, "", "which board");
    visit("name", self.name, "", "reversed domain: org.example.esc");
  }
};

/// Start again.
struct RestartNodeRequest {
  static constexpr DataType kType = {
      "uavcan.protocol.RestartNode", {5, TransferKind::kRequest}, 0x569E05394A3017F0};
  static constexpr std::uint64_t kMagicNumber = 0xACCE551B1E;

  std::uint64_t magic_number{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("magic_number", self.magic_number, "1", "0xACCE551B1E, lest a stray request restarts a motor",
          Bits{40});
  }
};

/// I will, or not.
struct RestartNodeResponse {
  static constexpr DataType kType = {
      "uavcan.protocol.RestartNode", {5, TransferKind::kResponse}, RestartNodeRequest::kType.signature};

  bool ok{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("ok", self.ok, "1", "it starts again");
  }
};

/// A wish for a node number, its grant, and the steps between them.
struct Allocation {
  static constexpr DataType kType = {
      "uavcan.protocol.dynamic_node_id.Allocation", {1, TransferKind::kMessage}, 0x0B2A812620A11D40};

  std::uint8_t node_id{};
  bool first_part_of_unique_id{};
  BoundedList<std::uint8_t, 16> unique_id{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("node_id", self.node_id, "1", "wished for or granted, 0 any", Bits{7});
    visit("first_part_of_unique_id", self.first_part_of_unique_id, "1", "a wish begins");
    visit("unique_id", self.unique_id, "1", "a part of it, or all of it in a grant");
  }
};

}  // namespace ironbird::hil_bridge::can
