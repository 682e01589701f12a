#include "hil_bridge/hil_fcu/stand_motors.hpp"

#include <algorithm>
#include <numbers>

namespace ironbird::hil_bridge {

namespace {

constexpr double kRadPerSecond = 2.0 * std::numbers::pi / 60.0;  // of a revolution per minute

}  // namespace

StandMotors::StandMotors(const can::EscControllerParams& params, transport::FrameBus& bus,
                         const InterlockStatus& gate, Time start)
    : bus_(bus),
      controller_(params, bus, start),
      gate_(gate),
      zeros_(static_cast<std::size_t>(params.count)),
      wanted_(zeros_),
      now_(start) {}

StandMotors::~StandMotors() {
  if (opened_) stop(now_);
}

void StandMotors::want(std::span<const double> throttles, Time stamp) {
  wanted_.assign(throttles.begin(), throttles.end());
  wanted_at_ = stamp;
}

bool StandMotors::sound() const {
  return wanted_.size() == zeros_.size() &&
         std::all_of(wanted_.begin(), wanted_.end(), [](double t) { return t >= 0.0 && t <= 1.0; });
}

void StandMotors::step(Time now) {
  now_ = now;
  if (gate_.state == InterlockState::kReleased || gate_.state == InterlockState::kLive) opened_ = true;
  const bool fresh = wanted_at_ != Time::min() && wanted_at_ <= now && now - wanted_at_ <= kGreatestAge;
  const bool turn = gate_.state == InterlockState::kLive && fresh && sound();
  if (turn) {
    controller_.set_armed(true);
    controller_.command(wanted_, now);
  } else {
    const bool above_zero = std::any_of(wanted_.begin(), wanted_.end(), [](double t) { return t != 0.0; });
    if (above_zero && wanted_at_ != Time::min()) ++status_.refused;
    if (opened_) stop(now);
  }
  controller_.step(now);
  status_.turning = turn;
  look(now);
}

void StandMotors::look(Time now) {
  status_.state = bus_.state();
  status_.frames = bus_.counters();
  const std::size_t count = std::min(zeros_.size(), status_.motors.size());
  for (std::size_t motor = 0; motor < count; ++motor) {
    const can::EscStatus& report = controller_.motor(motor).status;
    status_.motors[motor] = {controller_.motor_ready(motor, now),     report.rpm * kRadPerSecond,
                             static_cast<double>(report.voltage),     static_cast<double>(report.current),
                             static_cast<double>(report.temperature), report.error_count};
  }
}

void StandMotors::stop(Time now) {
  controller_.set_armed(false);
  controller_.command(zeros_, now);
}

}  // namespace ironbird::hil_bridge
