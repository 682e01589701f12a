#include "hil_bridge/transport/udp_socket.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <system_error>

namespace ironbird::hil_bridge::transport {

namespace {

constexpr int kDatagramsHeld = 1 << 20;  // bytes; the burst of all parameters is 11 kB
constexpr int kGreatestPort = 65535;

/// The first word of `text` up to a colon, which is taken away with it.
std::string_view next_word(std::string_view& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string_view word = text.substr(0, colon);
  text.remove_prefix(std::min(colon + 1, text.size()));
  return word;
}

bool read_port(std::string_view text, int& port) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, port);
  return read.ec == std::errc() && read.ptr == end && port >= 1 && port <= kGreatestPort;
}

}  // namespace

std::optional<UdpConfig> udp_peer(std::string_view text) {
  UdpConfig config;
  if (text.ends_with(':')) return std::nullopt;
  config.host = next_word(text);
  if (config.host.empty()) return std::nullopt;
  if (!text.empty() && !read_port(next_word(text), config.port)) return std::nullopt;
  if (!text.empty() && !read_port(text, config.local_port)) return std::nullopt;
  return config;
}

void UdpSocket::open() {
  if (const std::string problem = try_open(); !problem.empty()) throw LinkError(problem);
}

std::string UdpSocket::try_open() {
  FileDescriptor file(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!file) return std::string("no UDP socket: ") + std::strerror(errno);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(static_cast<std::uint16_t>(config_.local_port));
  here.sin_addr.s_addr = htonl(INADDR_ANY);
  if (bind(file.number(), reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) {
    return "UDP port " + std::to_string(config_.local_port) + ": " +
           (errno == EADDRINUSE ? "another program uses it; end that, or name another port"
                                : std::strerror(errno));
  }
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(config_.host.c_str(), std::to_string(config_.port).c_str(), &hints, &found);
  if (failed != 0) return config_.host + ": " + gai_strerror(failed) + "; name a host or an IPv4 address";
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  if (connect(file.number(), found->ai_addr, found->ai_addrlen) != 0) {
    return config_.host + ":" + std::to_string(config_.port) + ": " + std::strerror(errno);
  }
  setsockopt(file.number(), SOL_SOCKET, SO_RCVBUF, &kDatagramsHeld, sizeof kDatagramsHeld);
  file_ = std::move(file);
  return {};
}

std::size_t UdpSocket::read(std::span<std::uint8_t> to) {
  if (!file_) return 0;
  const ssize_t count = recv(file_.number(), to.data(), to.size(), 0);
  return count > 0 ? static_cast<std::size_t>(count) : 0;  // a refused earlier datagram is no end of the line
}

std::size_t UdpSocket::write(std::span<const std::uint8_t> from) {
  if (!file_) return 0;
  const ssize_t count = send(file_.number(), from.data(), from.size(), MSG_NOSIGNAL);
  // With nobody at the other port yet, the datagram is as good as sent.
  if (count < 0 && errno == ECONNREFUSED) return from.size();
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

std::string UdpSocket::name() const {
  return "UDP " + std::to_string(config_.local_port) + " to " + config_.host + ":" +
         std::to_string(config_.port);
}

}  // namespace ironbird::hil_bridge::transport
