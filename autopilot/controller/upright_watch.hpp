#pragma once

#include <optional>

#include "autopilot/controller/since.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Sees that a vehicle lies on its side or back, or is out of control, so that its motors are to be stopped.
///
/// It lies when it leans more than 60 deg and neither moves nor turns for a second: nothing that flies does.
/// It is out of control when it is asked to lean less than 45 deg, yet began to lean more than 60 deg three
/// seconds ago and has not leant less than 45 deg for half a second at a stretch since; time without an
/// estimate does not count. Who asks for more, for rates or for torques half a second long may fly as he
/// likes. The second stays so until the motors are disarmed or the pilot has it upright again.
class UprightWatch {
 public:
  /// One step.
  /// @param usable  the estimate is
  /// @param still  it neither moves nor turns
  /// @param asked  cosine of the lean that was asked for; none: no attitude was
  /// @param taken  pilot or failsafe have the vehicle
  void look(const StateEstimate& estimate, bool usable, bool still, const std::optional<double>& asked,
            bool taken);

  /// It lies on its side or back, and moves no more.
  bool lies(Time now) const;

  /// The vehicle is to be given no thrust.
  bool stops(Time now) const;

  /// It was out of control, and has been neither disarmed nor righted by the pilot.
  bool given_up() const { return given_up_; }

  /// As far as is known it leans too much to take off, or was out of control.
  bool overturned() const { return leans_ || given_up_; }

  /// Its motors are disarmed: it is no longer out of control. How it lies is another matter.
  void forgive();

  void reset() { *this = UprightWatch{}; }
  /// Goes on where another one stopped.
  void restore(bool given_up) { given_up_ = given_up; }

 private:
  bool blind_ = false;  // in the look before
  Time seen_{0};        // stamp of the last usable estimate
  bool leans_ = false;
  Since lies_;
  Since upright_;
  Since asked_far_;  // to lean far, or for no attitude
  Since out_of_control_;
  bool given_up_ = false;
};

}  // namespace ironbird::autopilot
