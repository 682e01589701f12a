#include "hil_bridge/executive/control_tick.hpp"

#include "hil_bridge/executive/page_faults.hpp"

namespace ironbird::hil_bridge {

namespace {

// A tick brings a handful of messages; the reserve keeps the step free of allocation.
constexpr std::size_t kInboxReserve = 4096;
constexpr std::size_t kTextReserve = 512;

}  // namespace

ControlTick::ControlTick(Fcu& fcu, autopilot::Autopilot& pilot, Guard& guard)
    : fcu_(fcu), pilot_(pilot), guard_(guard) {
  inbox_.reserve(kInboxReserve);
  texts_.reserve(kTextReserve);
}

void ControlTick::run(Time now, bool bench_in_time) {
  if (clock_ == nullptr) return tick(now, bench_in_time);
  const std::uint64_t before = page_faults_of_this_thread();
  tick(now, bench_in_time);
  timing_.page_faults += page_faults_of_this_thread() - before;
}

void ControlTick::tick(Time now, bool bench_in_time) {
  woke_ = now;
  stepped_ = sent_ = false;
  inbox_.clear();
  texts_.clear();
  fcu_.advance(now);
  fcu_.receive(inbox_);
  for (const Arrival& arrival : inbox_) take(arrival);
  guard_.step(pilot_.signals().estimate, bench_in_time, now);
  if (clock_ != nullptr) timing_.receive.add(mark() - woke_);
  for (const Arrival& arrival : inbox_) answer(arrival, now);
  if (!sent_) send_if_any(guard_.unasked(now));
}

void ControlTick::take(const Arrival& arrival) {
  guard_.take(arrival);
  telemetry_.take(arrival.message);
  const auto* text = std::get_if<rosflight::Statustext>(&arrival.message);
  if (text != nullptr && texts_.size() < kTextReserve) texts_.push_back(*text);
}

void ControlTick::answer(const Arrival& arrival, Time now) {
  const autopilot::SensorFrame* frame = builder_.push(arrival);
  if (frame == nullptr) return;
  stepped_ = true;
  const Time before = mark();
  const autopilot::FcuCommand& command = pilot_.step(*frame);
  const Time stepped = mark();
  send_if_any(guard_.answer(command, frame->imu.stamp, now));
  if (clock_ != nullptr) {
    const Time done = mark();
    timing_.step.add(stepped - before);
    timing_.send.add(done - stepped);
    timing_.response.add(done - woke_);
  }
  if (on_step_) on_step_(now);
}

void ControlTick::send_if_any(const std::optional<rosflight::OffboardControl>& control) {
  if (!control) return;
  fcu_.send(*control);
  sent_ = true;
}

}  // namespace ironbird::hil_bridge
