#pragma once

#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// When satellite position and filter disagree for good, tells which of them has moved. As long as the
/// Doppler velocity is believed, dead reckoning cannot have gone astray: a position that jumps without it is
/// the receiver's. Only while nothing was measured may the filter have drifted, as fast as it may be wrong.
class FixTrust {
 public:
  /// Position and velocity are known as they were at `then`.
  void begin(Time then) {
    last_ = then;
    lost_ = 0.0;
  }

  /// A velocity was believed.
  /// @param was_off  how wrong the filter's own may have been until then, m/s
  /// @param silence  a longer pause since the last was not measured, s
  void velocity_believed(Time now, double was_off, double silence) {
    lost_ += was_off * pause_before(now, silence);
    last_ = now;
  }

  /// A position was believed: whatever was lost is found again.
  void position_believed(Time now) { begin(now); }

  /// A position that disagrees by `distance`, m, does so because the receiver has stepped.
  /// @param may_be_off  how wrong the filter's velocity may be now, m/s
  bool blames_receiver(double distance, double may_be_off, Time now, double silence) const {
    return distance > lost_ + may_be_off * pause_before(now, silence);
  }

 private:
  double pause_before(Time now, double silence) const {
    const double pause = seconds(now - last_);
    return pause > silence ? pause : 0.0;
  }

  Time last_{0};
  double lost_ = 0.0;  // m, at most, since the last position that was believed
};

}  // namespace ironbird::autopilot
