#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "hil_bridge/transport/faulty_direction.hpp"
#include "hil_bridge/virtual_fcu/firmware_host.hpp"

namespace ironbird::scenarios {

/// How a line begins that is no device: `udp:HOST:PORT:OWN_PORT`.
inline constexpr std::string_view kUdp = "udp:";

/// Which flight-control unit is flown, and how it is reached.
enum class FcuKind : std::uint8_t {
  kVirtual,        ///< the virtual one, by function call
  kVirtualSerial,  ///< the virtual one, over a pseudo-terminal, as bytes, in lock-step
  kSerial,         ///< one at the other end of a line, in real time: there is no world but the real one
  kHil,            ///< one at the other end of a line, whose outputs turn the rotors of a simulated vehicle
};

constexpr std::array<std::pair<FcuKind, std::string_view>, 4> enumerators(FcuKind) {
  return {{{FcuKind::kVirtual, "virtual"},
           {FcuKind::kVirtualSerial, "virtual_serial"},
           {FcuKind::kSerial, "serial"},
           {FcuKind::kHil, "hil"}}};
}

/// The line that leads to a virtual unit on a desk in this process.
inline constexpr std::string_view kOwnUnit = "virtual";
// Where the rotors of hardware in the loop get their commands from: the unit's OUTPUT_RAW, a bus in this
// process, or, with the interface behind it, a bus of this machine.
inline constexpr std::string_view kOutputRaw = "output_raw";
inline constexpr std::string_view kOwnBus = "can";
inline constexpr std::string_view kCanInterface = "can:";

/// The flight-control unit: which one it is, and how the virtual one is set up.
struct FcuConfig : hil_bridge::VirtualFcuConfig {
  FcuKind kind = FcuKind::kVirtual;
  std::string line;
  int baud = 921600;
  double time_scale = 1.0;
  std::string motors{kOutputRaw};
  std::string stand;
  bool can_fd = false;
  double external_attitude = 0.0;
  hil_bridge::transport::LinkFaultConfig link_fault;
  hil_bridge::transport::LinkFaultConfig bus_fault;

  /// The unit is a virtual one in this process: flying it needs nothing else, and moves nothing else.
  bool has_own_unit() const {
    if (kind == FcuKind::kHil) return line.empty() || line == kOwnUnit;
    return kind != FcuKind::kSerial;
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("kind", self.kind, "1", "virtual, virtual_serial, serial: a real unit, or hil: a unit on a desk");
    visit("line", self.line, "",
          "serial, hil: the unit's port, as /dev/serial/by-id/NAME, or "
          "udp:HOST[:PORT[:OWN_PORT]], usually ports 14525 and 14520; "
          "hil: virtual, for a virtual unit in this process");
    visit("baud", self.baud, "Bd", "serial, hil: rate of the port", 300.0, 4e6);
    visit("time_scale", self.time_scale, "1",
          "hil over a line: seconds of the run in a second of the clock, as the unit's own", 0.001, 1.0);
    visit("motors", self.motors, "", "hil, what turns the rotors: output_raw, can, or can:INTERFACE");
    visit("stand", self.stand, "",
          "hil with output_raw: real motor controllers that do what the unit's outputs tell, can:INTERFACE");
    visit("can_fd", self.can_fd, "1", "hil: CAN FD frames on the bus of the motors, or of the stand");
    visit("external_attitude", self.external_attitude, "Hz",
          "hil: how often the unit is told the simulated attitude; 0: never", 0.0, 400.0);
    visit("link_fault", self.link_fault, "", "what goes wrong with the line, where there is one");
    visit("bus_fault", self.bus_fault, "", "hil: what goes wrong with the bus of the motors");
    VirtualFcuConfig::describe(self, visit);
  }
};

}  // namespace ironbird::scenarios
