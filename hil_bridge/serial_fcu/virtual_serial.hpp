#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hil_bridge/serial_fcu/serial_fcu.hpp"
#include "hil_bridge/transport/link_fault.hpp"

namespace ironbird::hil_bridge {

/// How a virtual unit is put on a line.
struct VirtualSerialConfig {
  std::uint8_t system = 1;
  std::optional<transport::LinkFaultConfig> faults;
  std::uint64_t seed = 1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("system", self.system, "1", "SYS_ID of the unit");
    visit("faults", self.faults, "", "what goes wrong at the companion's end; none: the line cannot fail");
    visit("seed", self.seed, "1", "of the faults");
  }
};

/// A virtual unit reached over a pseudo-terminal, in lock-step: everything that goes to it and comes from it
/// goes as bytes through the kernel, through the same decoder, port and connection as with a real unit. The
/// commands are those of the unit without the line, bit for bit.
///
/// Lock-step needs no thread: after each tick both ends read until as many bytes have arrived as were sent.
/// Cores are kept awake meanwhile (awake_cores.hpp), where that is permitted.
/// Faults of the line are decided frame by frame, in time of the run: same seed, same faults.
class VirtualSerialFcu final : public Fcu {
 public:
  /// @param unit  advanced by nobody else; outlives this
  /// @throws transport::LinkError where the machine has no pseudo-terminals
  explicit VirtualSerialFcu(Fcu& unit, const VirtualSerialConfig& config = {}, Gate* gate = nullptr);
  ~VirtualSerialFcu() override;

  /// @throws transport::LinkError when bytes that were sent do not arrive within a second
  void advance(Time now) override;
  void receive(std::vector<Arrival>& out) override;
  void send(const rosflight::Message& message) override;

  /// From now on this gate is asked before anything leaves. @param gate  outlives this
  void set_gate(Gate& gate);

  const SerialFcu& serial() const;
  /// The faults of the line, to be changed on the way; null: it has none.
  transport::LinkFault* faults();
  /// Bytes that went to the unit and came from it.
  std::uint64_t bytes_up() const;
  std::uint64_t bytes_down() const;

 private:
  struct Line;
  std::unique_ptr<Line> line_;
};

}  // namespace ironbird::hil_bridge
