#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hil_bridge/transport/byte_stream.hpp"
#include "hil_bridge/transport/file_descriptor.hpp"

namespace ironbird::hil_bridge::transport {

/// Which two ports. The usual ones: the unit binds 14525 and sends to 14520, the companion the other way
/// round.
struct UdpConfig {
  int local_port = 14520;
  std::string host = "localhost";
  int port = 14525;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("local_port", self.local_port, "1", "port of this side", 1, 65535);
    visit("host", self.host, "", "name or address of the other side");
    visit("port", self.port, "1", "port of the other side", 1, 65535);
  }
};

/// The other side as a user writes it: HOST, HOST:PORT, or HOST:PORT:OWN_PORT; a port that is not named is
/// the usual one. @return nothing for a text that is none of them
std::optional<UdpConfig> udp_peer(std::string_view text);

/// A line of datagrams, IPv4. Each write is one datagram; a read takes one, and what of it does not fit is
/// lost, so read with `kReadRoom`. It is up as long as this side has its port, whether or not somebody
/// listens.
class UdpSocket final : public ByteStream {
 public:
  explicit UdpSocket(const UdpConfig& config) : config_(config) {}

  /// @throws LinkError
  void open();

  std::size_t read(std::span<std::uint8_t> to) override;
  std::size_t write(std::span<const std::uint8_t> from) override;
  bool is_up() const override { return static_cast<bool>(file_); }
  bool reopen() override { return is_up() || try_open().empty(); }
  int descriptor() const override { return file_.number(); }
  std::string name() const override;

 private:
  std::string try_open();

  UdpConfig config_;
  FileDescriptor file_;
};

}  // namespace ironbird::hil_bridge::transport
