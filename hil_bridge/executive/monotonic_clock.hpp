#pragma once

#include "hil_bridge/executive/clock.hpp"

namespace ironbird::hil_bridge {

/// The machine's monotonic clock, from the moment of construction.
class MonotonicClock final : public Clock {
 public:
  MonotonicClock();
  Time now() override;
  void wait(int descriptor, Time until) override;

 private:
  Time start_;
};

}  // namespace ironbird::hil_bridge
