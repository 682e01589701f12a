#include "hil_bridge/transport/serial_settings.hpp"

// The kernel's own header knows any rate (termios2); the C library's does not, and the two do not go
// together.
#include <asm/termbits.h>
#include <linux/serial.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace ironbird::hil_bridge::transport {

namespace {

// A pseudo-terminal and a USB port agree to anything; a real converter must come close for bytes to arrive.
constexpr int kBaudTolerancePercent = 3;

/// The rate that the driver makes of what was asked for, Bd, or 0.
int actual_baud(int descriptor) {
  termios2 settings{};
  return ioctl(descriptor, TCGETS2, &settings) == 0 ? static_cast<int>(settings.c_ospeed) : 0;
}

}  // namespace

std::string set_raw(int descriptor, int baud) {
  termios2 settings{};
  if (ioctl(descriptor, TCGETS2, &settings) != 0) {
    return std::strerror(errno);
  }
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  settings.c_ispeed = static_cast<speed_t>(baud);
  settings.c_ospeed = static_cast<speed_t>(baud);
  if (ioctl(descriptor, TCSETS2, &settings) != 0) return std::strerror(errno);
  const int made = actual_baud(descriptor);
  if (std::abs(made - baud) * 100LL > static_cast<long long>(baud) * kBaudTolerancePercent) {
    return "it makes " + std::to_string(made) + " Bd of the " + std::to_string(baud) + " Bd asked for";
  }
  ioctl(descriptor, TCFLSH, TCIOFLUSH);  // what lay in the queues belongs to somebody else
  return {};
}

bool set_low_latency(int descriptor) {
  serial_struct settings{};
  if (ioctl(descriptor, TIOCGSERIAL, &settings) != 0) return false;
  settings.flags |= ASYNC_LOW_LATENCY;
  return ioctl(descriptor, TIOCSSERIAL, &settings) == 0;
}

}  // namespace ironbird::hil_bridge::transport
