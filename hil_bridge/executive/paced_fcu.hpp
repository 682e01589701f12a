#pragma once

#include <vector>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// Lets time pass no faster than the clock of the wall: what is behind it runs in real time, or at a fraction
/// of it, in whatever loop it stands.
///
/// A loop that falls far behind does not catch up, since whoever is at the other end of the line goes on: its
/// clock is set anew, and what was lost is counted.
class PacedFcu final : public Fcu {
 public:
  /// Further behind there is no catching up, of the clock of the wall.
  static constexpr Time kGivenUp = std::chrono::milliseconds(200);

  /// @param fcu         outlives this
  /// @param time_scale  seconds of the run in a second of the clock, 0.001 to 1
  /// @throws std::invalid_argument naming value and bound
  PacedFcu(Fcu& fcu, double time_scale);

  /// Waits until it is time. @return what was lost since the last call, because the loop came too late, of
  /// the run's time
  Time wait(Time now);
  void advance(Time now) override;
  void receive(std::vector<Arrival>& out) override { fcu_.receive(out); }
  void send(const rosflight::Message& message) override { fcu_.send(message); }

  /// Of the clock of the wall.
  Time lost() const { return lost_; }

 private:
  void sleep_until(Time now);

  Fcu& fcu_;
  double time_scale_;
  Time zero_ = Time::min();  // of the run, on the clock of the wall
  Time lost_{};
  Time unseen_{};  // of what was lost, of the run's time
};

}  // namespace ironbird::hil_bridge
