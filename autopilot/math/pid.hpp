#pragma once

#include <limits>

namespace ironbird::autopilot {

/// Gains of one loop, in SI units of what goes in and what comes out.
struct PidGains {
  double kp = 0.0;
  double ki = 0.0;
  double kd = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("kp", self.kp, "SI", "output per error", 0.0, 1000.0);
    visit("ki", self.ki, "SI", "output per integral of the error", 0.0, 1000.0);
    visit("kd", self.kd, "SI", "output per rate of the measured quantity", 0.0, 1000.0);
  }
};

/// One loop: u = kp e + ki int(e) - kd (rate), kept within limits.
///
/// The rate is that of the measured quantity, given by the caller or found with a filtered derivative, so
/// that a step of the command does not kick. Against wind-up the integral rests while proportional and
/// derivative parts alone are at a limit, and never takes more than what they leave of it. ROScopter paper,
/// section on the controller. It does not wrap angles: give it an error that is already the shortest way.
class Pid {
 public:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  /// Longer gaps than this are not integrated or differentiated over, s.
  static constexpr double kStale = 1.0;

  /// Sets gains and limits. The integral is cleared when ki changes, and kept otherwise.
  /// @param time_constant  of the filtered derivative, s, > 0
  void configure(const PidGains& gains, double time_constant, double lower = -kUnlimited,
                 double upper = kUnlimited);

  /// One step with a measured rate. Returns 0 and keeps its state when an argument is not finite.
  /// @param error      command minus measurement
  /// @param rate       of the measurement; minus the commanded rate where there is one
  /// @param dt         since the previous step, s; at 0 nothing is integrated
  /// @param integrate  false: the integral stands still
  double run(double error, double rate, double dt, bool integrate = true);

  /// The same, with the rate found from `measurement` by a first-order filtered derivative.
  double run_filtered(double error, double measurement, double dt, bool integrate = true);

  /// Sets the integral so that a step with these arguments gives `output`, as far as limits and gains allow:
  /// to go on where another loop stopped.
  void aim(double error, double rate, double output);

  /// Forgets the integral.
  void reset_integral();

  /// Forgets everything but gains and limits.
  void reset();

  /// The integral's share of the output.
  double integral_part() const { return gains_.ki * integral_; }

 private:
  PidGains gains_;
  double time_constant_ = 0.05;
  double lower_ = -kUnlimited;
  double upper_ = kUnlimited;
  double integral_ = 0.0;
  double previous_error_ = 0.0;
  double previous_measurement_ = 0.0;
  double derivative_ = 0.0;
  bool has_error_ = false;
  bool has_measurement_ = false;
};

}  // namespace ironbird::autopilot
