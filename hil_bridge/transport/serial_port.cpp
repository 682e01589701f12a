#include "hil_bridge/transport/serial_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "hil_bridge/transport/serial_settings.hpp"
#include "hil_bridge/transport/terminal_owner.hpp"

namespace ironbird::hil_bridge::transport {

namespace fs = std::filesystem;

namespace {

constexpr const char* kLastingNames = "/dev/serial/by-id";

/// The name below /dev/serial/by-id that leads to this device, if one does.
std::optional<std::string> lasting_name_of(const std::string& path) {
  std::error_code error;
  const fs::path device = fs::canonical(path, error);
  if (error) return std::nullopt;
  for (const fs::directory_entry& entry : fs::directory_iterator(kLastingNames, error)) {
    std::error_code dangling;
    if (fs::canonical(entry.path(), dangling) == device && !dangling) return entry.path().string();
  }
  return std::nullopt;
}

std::string listed(const std::vector<std::string>& names) {
  if (names.empty()) return "this machine has no serial port: is the cable in?";
  std::string text = "there are:";
  for (const std::string& name : names) text += ' ' + name;
  return text;
}

bool is_pseudo_terminal(const std::string& path) {
  std::error_code error;
  return fs::canonical(path, error).string().starts_with("/dev/pts/");
}

/// Throws away what was said before anybody listened. Flushing its queues does not empty a pseudo-terminal:
/// the kernel holds up to 64 KiB more, which it brings when it likes, and then the sender has a queue of its
/// own.
void forget_the_past(int descriptor) {
  constexpr auto kLong = std::chrono::milliseconds(100);
  constexpr int kPause = 2;  // ms
  const auto end = std::chrono::steady_clock::now() + kLong;
  std::array<std::uint8_t, 4096> bytes;
  while (std::chrono::steady_clock::now() < end) {
    if (::read(descriptor, bytes.data(), bytes.size()) > 0) continue;
    pollfd state{descriptor, POLLIN, 0};
    poll(&state, 1, kPause);
    if ((state.revents & (POLLHUP | POLLERR)) != 0) return;
  }
}

std::string taken(const std::string& path) {
  const std::string user = user_of_device(path);
  return path + ": " + (user.empty() ? "another program" : user) + " uses it; end that first";
}

std::string not_a_port(const std::string& path) {
  return path + ": it is not a serial port; " + listed(serial_ports());
}

std::string why_not(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return path + ": there is no such port; " + listed(serial_ports());
    case EACCES:
    case EPERM:
      return path +
             ": no permission; add yourself to the group of the device, usually `sudo usermod -aG dialout "
             "$USER`, and log in again";
    case EBUSY:
      return taken(path);
    case EISDIR:
      return not_a_port(path);
    default:
      return path + ": " + std::strerror(error);
  }
}

}  // namespace

std::vector<std::string> serial_ports() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(kLastingNames, error)) {
    names.push_back(entry.path().string());
  }
  for (const fs::directory_entry& entry : fs::directory_iterator("/dev", error)) {
    const std::string name = entry.path().string();
    const bool usb = name.starts_with("/dev/ttyACM") || name.starts_with("/dev/ttyUSB");
    if (usb && !lasting_name_of(name)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

SerialPort::SerialPort(const SerialPortConfig& config) : config_(config) {
  constexpr int kLeast = 300;
  constexpr int kMost = 4'000'000;
  if (config.baud < kLeast || config.baud > kMost) {
    throw std::invalid_argument("fcu.baud = " + std::to_string(config.baud) +
                                " Bd, must be within 300..4000000 Bd");
  }
}

void SerialPort::open() {
  std::string why;
  if (!try_open(&why)) throw LinkError(why);
}

bool SerialPort::reopen() {
  return is_up() || try_open(nullptr);
}

bool SerialPort::try_open(std::string* why) {
  if (lasting_name_ && try_open(*lasting_name_, nullptr)) return true;
  const bool opened = try_open(config_.path, why);
  if (opened && !lasting_name_) lasting_name_ = lasting_name_of(config_.path);
  return opened;
}

// Looking for who has a port, or which there are, and waiting until its past has come takes longer than a
// control loop has.
bool SerialPort::try_open(const std::string& path, std::string* why) {
  const auto refuse = [why](const auto& explain) {
    if (why != nullptr) *why = explain();
    return false;
  };
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!file) return refuse([&path, error = errno] { return why_not(path, error); });
  if (isatty(file.number()) == 0 && errno == ENOTTY) return refuse([&path] { return not_a_port(path); });
  // The lock is for programs that ask for it, the exclusive mode for those that do not and come later; root
  // passes the latter. On a pseudo-terminal that mode would outlive a killed program.
  if (flock(file.number(), LOCK_EX | LOCK_NB) != 0) return refuse([&path] { return taken(path); });
  if (why != nullptr && !user_of_device(path).empty()) return refuse([&path] { return taken(path); });
  if (const std::string problem = set_raw(file.number(), config_.baud); !problem.empty()) {
    return refuse([&] { return path + ": " + problem; });
  }
  if (!is_pseudo_terminal(path)) ioctl(file.number(), TIOCEXCL);
  set_low_latency(file.number());
  if (why != nullptr) forget_the_past(file.number());
  file_ = std::move(file);
  return true;
}

std::size_t SerialPort::read(std::span<std::uint8_t> to) {
  if (!file_ || to.empty()) return 0;
  const ssize_t count = ::read(file_.number(), to.data(), to.size());
  if (count > 0) return static_cast<std::size_t>(count);
  // Without VMIN a line with nothing to read and one that was cut both give 0; poll tells them apart.
  pollfd state{file_.number(), POLLIN, 0};
  const bool quiet = count == 0 || errno == EAGAIN || errno == EINTR;
  const bool cut = poll(&state, 1, 0) > 0 && (state.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  if (!quiet || cut) file_.close();
  return 0;
}

std::size_t SerialPort::write(std::span<const std::uint8_t> from) {
  if (!file_ || from.empty()) return 0;
  const ssize_t count = ::write(file_.number(), from.data(), from.size());
  if (count >= 0) return static_cast<std::size_t>(count);
  if (errno != EAGAIN && errno != EINTR) file_.close();
  return 0;
}

std::string SerialPort::name() const {
  return config_.path + " at " + std::to_string(config_.baud) + " Bd";
}

}  // namespace ironbird::hil_bridge::transport
