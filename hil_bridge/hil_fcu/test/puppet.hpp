#pragma once

#include <vector>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge::test {

inline constexpr Time kTick = std::chrono::microseconds(2500);

/// A unit that says what the test wants, and remembers what it was told.
class Puppet final : public Fcu {
 public:
  void advance(Time now) override { now_ = now; }
  void receive(std::vector<Arrival>& out) override {
    for (const rosflight::Message& message : says) out.push_back({now_, message});
    says.clear();
  }
  void send(const rosflight::Message& message) override { told.push_back(message); }

  std::vector<rosflight::Message> says;
  std::vector<rosflight::Message> told;

 private:
  Time now_{};
};

}  // namespace ironbird::hil_bridge::test
