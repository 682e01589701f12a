#include "hil_bridge/transport/awake_cores.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

namespace ironbird::hil_bridge::transport {

namespace {

constexpr const char* kDevice = "/dev/cpu_dma_latency";

}  // namespace

AwakeCores::AwakeCores() : wish_(::open(kDevice, O_WRONLY | O_CLOEXEC)) {
  constexpr std::int32_t kLatency = 0;  // us
  if (wish_ && ::write(wish_.number(), &kLatency, sizeof kLatency) == sizeof kLatency) return;
  if (!wish_ && (errno == ENOENT || errno == ENXIO)) {
    missing_ = std::string("no ") + kDevice +
               " here, as in most containers: idle cores fall asleep, a command may be 0.1 ms later";
    return;
  }
  wish_.close();
  missing_ = std::string(
                 "no right to keep idle cores awake: a command may be 0.1 ms later; allow it with a udev "
                 "rule by which you may write ") +
             kDevice;
}

}  // namespace ironbird::hil_bridge::transport
