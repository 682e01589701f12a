#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hil_bridge/transport/byte_stream.hpp"
#include "hil_bridge/transport/file_descriptor.hpp"

namespace ironbird::hil_bridge::transport {

/// Which serial line.
struct SerialPortConfig {
  std::string path;
  int baud = 921600;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("path", self.path, "", "device, as /dev/ttyACM0 or, better, its name below /dev/serial/by-id");
    visit("baud", self.baud, "Bd", "rate; a USB port of the unit itself ignores it", 300, 4'000'000);
  }
};

/// A serial line: raw bytes, any rate, nobody else on it.
///
/// When the plug is pulled the line goes down, and `reopen` finds the device again by its name below
/// /dev/serial/by-id, whatever number the kernel gives it this time.
class SerialPort final : public ByteStream {
 public:
  /// Opens nothing: call `open` to hear why not, or `reopen` to wait for a cable.
  explicit SerialPort(const SerialPortConfig& config);

  /// What was said before is not heard: it listens for 0.1 s first. @throws LinkError saying what is wrong
  /// and what to do
  void open();

  std::size_t read(std::span<std::uint8_t> to) override;
  std::size_t write(std::span<const std::uint8_t> from) override;
  bool is_up() const override { return static_cast<bool>(file_); }
  bool reopen() override;
  int descriptor() const override { return file_.number(); }
  std::string name() const override;

 private:
  /// @param why  set to what is wrong and what to do, when it is not null: that takes its time
  bool try_open(std::string* why);
  bool try_open(const std::string& path, std::string* why);

  SerialPortConfig config_;
  std::optional<std::string> lasting_name_;
  FileDescriptor file_;
};

/// The serial ports that this machine has, by their lasting names where they have one.
std::vector<std::string> serial_ports();

}  // namespace ironbird::hil_bridge::transport
