#include "hil_bridge/serial_fcu/virtual_serial.hpp"

#include <poll.h>

#include <cstdint>
#include <span>
#include <string>

#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/transport/awake_cores.hpp"
#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "hil_bridge/transport/serial_port.hpp"
#include "hil_bridge/virtual_fcu/served_fcu.hpp"

namespace ironbird::hil_bridge {

namespace {

constexpr int kPatience =
    1000;  // ms; a loaded machine may take a while to carry a byte, a broken one takes for ever
constexpr int kAnyBaud = 921600;

/// Counts what goes through one end of a line.
class CountedStream final : public transport::ByteStream {
 public:
  explicit CountedStream(transport::ByteStream& line) : line_(line) {}
  std::size_t read(std::span<std::uint8_t> to) override {
    const std::size_t count = line_.read(to);
    read_ += count;
    return count;
  }
  std::size_t write(std::span<const std::uint8_t> from) override {
    const std::size_t count = line_.write(from);
    written_ += count;
    return count;
  }
  bool is_up() const override { return line_.is_up(); }
  bool reopen() override { return line_.reopen(); }
  int descriptor() const override { return line_.descriptor(); }
  std::string name() const override { return line_.name(); }
  std::uint64_t bytes_read() const { return read_; }
  std::uint64_t bytes_written() const { return written_; }

 private:
  transport::ByteStream& line_;
  std::uint64_t read_ = 0;
  std::uint64_t written_ = 0;
};

void wait_for_bytes(const transport::ByteStream& line) {
  pollfd state{line.descriptor(), POLLIN, 0};
  if (poll(&state, 1, kPatience) > 0) return;
  throw transport::LinkError(line.name() + ": bytes that were sent did not arrive within a second");
}

}  // namespace

struct VirtualSerialFcu::Line {
  Line(Fcu& fcu, const VirtualSerialConfig& config, Gate* gate)
      : unit(fcu),
        port({terminal.device(), kAnyBaud}),
        there(terminal),
        here(port),
        faults(config.faults ? std::make_unique<transport::LinkFault>(here, *config.faults, config.seed,
                                                                      &rosflight::piece_length)
                             : nullptr),
        served(fcu, there, config.system),
        serial(faults ? static_cast<transport::ByteStream&>(*faults) : here,
               {.system = config.system, .synchronise = false, .download = true}, gate) {
    if (!port.reopen()) port.open();  // a line that was made just now has no past; `open` says what is wrong
  }

  /// Until all that was sent to the unit before `now` is there.
  void bring_up(Time now) {
    if (faults) {
      const Time before = now - Time(1);
      for (faults->advance(before); faults->waiting() || !serial.flush(); faults->advance(before)) {
        served.take();
      }
    } else {
      while (!serial.flush()) served.take();
    }
    for (served.take(); there.bytes_read() < here.bytes_written(); served.take()) wait_for_bytes(there);
  }

  /// Until all that the unit says is here.
  void bring_down(Time now) {
    do {
      served.give();
      if (faults) faults->advance(now);
      serial.advance(now);
      if (here.bytes_read() < there.bytes_written()) wait_for_bytes(here);
    } while (!served.all_given() || here.bytes_read() < there.bytes_written());
  }

  transport::AwakeCores awake;  // where it may: a tick waits twice for the kernel to carry bytes
  Fcu& unit;
  transport::PseudoTerminal terminal;
  transport::SerialPort port;
  CountedStream there;
  CountedStream here;
  std::unique_ptr<transport::LinkFault> faults;
  ServedFcu served;
  SerialFcu serial;
};

VirtualSerialFcu::VirtualSerialFcu(Fcu& unit, const VirtualSerialConfig& config, Gate* gate)
    : line_(std::make_unique<Line>(unit, config, gate)) {}
VirtualSerialFcu::~VirtualSerialFcu() = default;

void VirtualSerialFcu::advance(Time now) {
  line_->bring_up(now);
  line_->unit.advance(now);
  line_->bring_down(now);
}

void VirtualSerialFcu::receive(std::vector<Arrival>& out) {
  line_->serial.receive(out);
}

void VirtualSerialFcu::send(const rosflight::Message& message) {
  line_->serial.send(message);
}

void VirtualSerialFcu::set_gate(Gate& gate) {
  line_->serial.set_gate(gate);
}

const SerialFcu& VirtualSerialFcu::serial() const {
  return line_->serial;
}
transport::LinkFault* VirtualSerialFcu::faults() {
  return line_->faults.get();
}
std::uint64_t VirtualSerialFcu::bytes_up() const {
  return line_->here.bytes_written();
}
std::uint64_t VirtualSerialFcu::bytes_down() const {
  return line_->there.bytes_written();
}

}  // namespace ironbird::hil_bridge
