#include "hil_bridge/hil_fcu/stand_unit.hpp"

#include <algorithm>
#include <span>
#include <variant>

namespace ironbird::hil_bridge {

void StandUnit::advance(Time now) {
  now_ = now;
  unit_.advance(now);
}

void StandUnit::receive(std::vector<Arrival>& out) {
  const std::size_t before = out.size();
  unit_.receive(out);
  for (const Arrival& arrival : std::span(out).subspan(before)) {
    const auto* told = std::get_if<rosflight::RosflightOutputRaw>(&arrival.message);
    if (told != nullptr && motors_) take(*told);
  }
}

void StandUnit::take(const rosflight::RosflightOutputRaw& told) {
  const auto count = std::min(static_cast<std::size_t>(params_.count), wanted_.size());
  std::copy_n(told.values.begin(), count, wanted_.begin());
  motors_->want(std::span(wanted_).first(count), now_);
}

}  // namespace ironbird::hil_bridge
