#pragma once

#include <string>

#include "hil_bridge/transport/file_descriptor.hpp"

namespace ironbird::hil_bridge::transport {

/// While one lives no core of this machine falls asleep when it has nothing to do: to wake one takes 0.1 ms
/// on some, four times as long as the control loop needs to answer a frame. Asks the kernel for a wake-up
/// latency of 0 us (PM QoS, /dev/cpu_dma_latency), which costs current; the wish ends with the program,
/// however that ends. Never fails.
class AwakeCores {
 public:
  AwakeCores();

  /// What was not granted and how to get it, one line; empty when it was.
  const std::string& missing() const { return missing_; }

 private:
  FileDescriptor wish_;
  std::string missing_;
};

}  // namespace ironbird::hil_bridge::transport
