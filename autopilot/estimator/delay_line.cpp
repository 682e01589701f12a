#include "autopilot/estimator/delay_line.hpp"

namespace ironbird::autopilot {

void DelayLine::clear() {
  newest_ = kCapacity - 1;
  count_ = 0;
  corrected_p_N_.setZero();
  corrected_v_N_.setZero();
}

void DelayLine::push(Time stamp, const Vector3& p_N, const Vector3& v_N) {
  if (count_ > 0 && stamp - entry(0).stamp < kLeastSpacing) return;
  newest_ = (newest_ + 1) % kCapacity;
  if (count_ < kCapacity) ++count_;
  entries_[newest_] = {stamp, p_N - corrected_p_N_, v_N - corrected_v_N_};
}

void DelayLine::correct(const Vector3& dp_N, const Vector3& dv_N) {
  corrected_p_N_ += dp_N;
  corrected_v_N_ += dv_N;
}

std::optional<DelayLine::Past> DelayLine::at(Time stamp) const {
  if (count_ == 0) return std::nullopt;
  if (stamp >= entry(0).stamp) return Past{entry(0).p_N + corrected_p_N_, entry(0).v_N + corrected_v_N_};
  for (int age = 1; age < count_; ++age) {
    const Entry& before = entry(age);
    if (before.stamp > stamp) continue;
    const Entry& after = entry(age - 1);
    const double fraction = seconds(stamp - before.stamp) / seconds(after.stamp - before.stamp);
    return Past{before.p_N + fraction * (after.p_N - before.p_N) + corrected_p_N_,
                before.v_N + fraction * (after.v_N - before.v_N) + corrected_v_N_};
  }
  return std::nullopt;
}

}  // namespace ironbird::autopilot
