#include "hil_bridge/hil_fcu/hil_fcu.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace ironbird::hil_bridge {

namespace {

constexpr std::size_t kRoomForMessages = 4096;

/// What a unit tells of its own sensors that the simulation tells instead.
bool is_sensed(const rosflight::Message& message) {
  return std::visit(
      [](const auto& content) {
        using Content = std::decay_t<decltype(content)>;
        return std::is_same_v<Content, rosflight::SmallImu> || std::is_same_v<Content, rosflight::SmallMag> ||
               std::is_same_v<Content, rosflight::SmallBaro> ||
               std::is_same_v<Content, rosflight::SmallRange> ||
               std::is_same_v<Content, rosflight::DiffPressure> ||
               std::is_same_v<Content, rosflight::RosflightGnss>;
      },
      message);
}

Time period_of(double rate) {
  return rate > 0.0 ? Time(std::llround(1e9 / rate)) : Time::zero();
}

}  // namespace

HilFcu::HilFcu(const VirtualFcuConfig& config, simulator::World& world, Fcu& unit, CanMotors* motors,
               double external_attitude)
    : world_(world),
      unit_(unit),
      motors_(motors),
      sensors_(config),
      period_(config.tick),
      attitude_period_(period_of(external_attitude)),
      next_attitude_(attitude_period_) {
  arrivals_.reserve(kRoomForMessages);
  inbox_.reserve(kRoomForMessages);
}

void HilFcu::advance(Time now) {
  while (now_ + period_ <= now) tick(now_ + period_);
}

void HilFcu::tick(Time next) {
  commands_ = motors_ != nullptr ? motors_->step(world_.truth(), now_) : told_outputs(now_);
  world_.set_armed(armed_);
  world_.step(commands_, next);
  now_ = next;
  sensors_.tick(world_.readings(), next);
  if (attitude_period_ > Time::zero() && next >= next_attitude_) send_attitude(next);
  unit_.advance(next);
  take_from_unit(next);
  take_from_sensors();
}

simulator::RotorCommands HilFcu::told_outputs(Time now) const {
  return told_ && now - *told_ <= kOutputSilence ? outputs_ : simulator::RotorCommands{};
}

void HilFcu::send_attitude(Time now) {
  next_attitude_ += ((now - next_attitude_) / attitude_period_ + 1) * attitude_period_;
  const simulator::Quaternion& q_NB = world_.truth().q_NB;
  unit_.send(rosflight::ExternalAttitude{static_cast<float>(q_NB.w()), static_cast<float>(q_NB.x()),
                                         static_cast<float>(q_NB.y()), static_cast<float>(q_NB.z())});
}

void HilFcu::take_from_unit(Time now) {
  arrivals_.clear();
  unit_.receive(arrivals_);
  for (const Arrival& arrival : arrivals_) {
    if (is_sensed(arrival.message)) continue;
    if (const auto* status = std::get_if<rosflight::RosflightStatus>(&arrival.message)) {
      armed_ = status->armed != 0;
    } else if (const auto* raw = std::get_if<rosflight::RosflightOutputRaw>(&arrival.message)) {
      for (std::size_t k = 0; k < outputs_.throttle.size(); ++k) {
        const double output = static_cast<double>(raw->values[k]);
        outputs_.throttle[k] = output > 0.0 ? std::min(output, 1.0) : 0.0;  // false for what is no number
      }
      told_ = now;
    }
    inbox_.push_back(arrival);
  }
}

void HilFcu::take_from_sensors() {
  arrivals_.clear();
  sensors_.receive(arrivals_);
  for (const Arrival& arrival : arrivals_) {
    if (is_sensed(arrival.message)) inbox_.push_back(arrival);
  }
}

void HilFcu::receive(std::vector<Arrival>& out) {
  out.insert(out.end(), inbox_.begin(), inbox_.end());
  inbox_.clear();
}

}  // namespace ironbird::hil_bridge
