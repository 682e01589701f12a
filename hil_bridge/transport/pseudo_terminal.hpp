#pragma once

#include <string>

#include "hil_bridge/transport/byte_stream.hpp"
#include "hil_bridge/transport/file_descriptor.hpp"

namespace ironbird::hil_bridge::transport {

/// The unit's end of a serial line that exists in this machine only: the other end is a device that any
/// program may open as a serial port.
class PseudoTerminal final : public ByteStream {
 public:
  /// @param link  where a symbolic link to the device is made, or empty. The link of a pseudo-terminal that
  ///              is no more is replaced, anything else is not
  /// @throws LinkError saying what is there, and whose
  explicit PseudoTerminal(std::string link = {});
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() override;

  /// The device of the other end; another one after every hang-up.
  const std::string& device() const { return device_; }

  std::size_t read(std::span<std::uint8_t> to) override;
  std::size_t write(std::span<const std::uint8_t> from) override;
  bool is_up() const override { return static_cast<bool>(file_); }
  /// Makes a new device, and the link point to it.
  bool reopen() override;
  int descriptor() const override { return file_.number(); }
  std::string name() const override { return link_.empty() ? device_ : link_; }

  /// As if the plug were pulled: device and link are gone until `reopen`.
  void hang_up();

 private:
  void remove_link();
  std::string try_open();

  std::string link_;
  std::string device_;
  FileDescriptor file_;
  FileDescriptor other_;  // kept open, so that a program that closes its end hangs nothing up
};

}  // namespace ironbird::hil_bridge::transport
