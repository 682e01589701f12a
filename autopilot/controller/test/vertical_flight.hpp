#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "autopilot/controller/cascaded_controller.hpp"

namespace ironbird::autopilot {

/// A vehicle that goes up and down only, over ground at height 0, its controller, and an estimate that misses
/// part of every blow, because it is shorter than a sample.
class VerticalFlight {
 public:
  static constexpr double kStep = 0.0025;  // s

  VerticalFlight() {
    estimate.health = Health::kGood;
    status.armed = true;
  }

  /// @param pilot    lift of the pilot's throttle, share of the weight; none: the controller flies
  /// @param holding  what he holds it with, bits of `rc_override`
  void live(double seconds, std::optional<double> pilot = {}, int holding = 0x003) {
    for (int i = 0; i < std::lround(seconds / kStep); ++i) {
      status.rc_override = pilot ? holding : 0;
      estimate.stamp += std::chrono::microseconds(2500);
      const FcuCommand& command = controller.run(NoSetpoint{}, false, estimate, status);
      const auto* direct = std::get_if<PassThroughCommand>(&command);
      lift = pilot.value_or(direct == nullptr ? 0.0 : direct->thrust / weight());
      status.greatest_output = lift < 0.1 ? 0.1 : 0.6;
      const double drag =
          terminal_speed ? v_down * std::abs(v_down) / (*terminal_speed * *terminal_speed) : 0.0;
      move(controller.params().gravity * (1.0 - lift - drag));
    }
  }

  bool ask(FlightWish wish) { return controller.request(wish, estimate, status).accepted; }
  bool on_ground() const { return height <= 0.0; }

  CascadedController controller;
  StateEstimate estimate;
  FcuStatus status;
  double height = 0.0;  // m
  double v_down = 0.0;  // m/s
  double lift = 0.0;
  std::optional<double> terminal_speed;  // m/s, of a fall without thrust; none: no drag

 private:
  static constexpr double kMissed = 0.3;  // of the speed of an impact

  double weight() const { return controller.params().mass * controller.params().gravity; }

  void move(double a_down) {
    const double before = v_down;
    v_down += a_down * kStep;
    height -= v_down * kStep;
    double seen = v_down - before;
    if (height < 0.0) {
      seen = -(1.0 - kMissed) * before;
      height = v_down = 0.0;
    }
    estimate.v_NB_B.z() += seen;
    estimate.p_NB_N.z() += estimate.v_NB_B.z() * kStep;
  }
};

}  // namespace ironbird::autopilot
