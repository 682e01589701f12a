#include "hil_bridge/serial_fcu/link_statistics.hpp"

namespace ironbird::hil_bridge {

namespace {

constexpr Time kSecond = std::chrono::seconds(1);
// A greater gap is a frame that came late or twice, or a unit that began anew: not 200 losses.
constexpr std::uint8_t kGreatestGap = 128;

}  // namespace

void LinkStatistics::take(const rosflight::Frame& frame, Time now) {
  if (sequence_) {
    const auto gap = static_cast<std::uint8_t>(frame.sequence - *sequence_ - 1U);
    if (gap < kGreatestGap) lost_ += gap;
  }
  sequence_ = frame.sequence;
  last_frame_ = now;
  ++counting_[frame.message.index()];
}

void LinkStatistics::advance(Time now, const rosflight::DecoderCounts& counts) {
  const Time passed = now - second_began_;
  if (passed < kSecond) return;
  const double seconds = std::chrono::duration<double>(passed).count();
  const auto frames = static_cast<double>(counts.frames - at_second_.frames);
  const auto lost = static_cast<double>(lost_ - lost_at_second_);
  frame_rate_ = frames / seconds;
  byte_rate_ = static_cast<double>(counts.bytes - at_second_.bytes) / seconds;
  loss_ = frames + lost > 0.0 ? lost / (frames + lost) : 0.0;
  rates_ = counting_;
  counting_ = {};
  second_began_ = now;
  at_second_ = counts;
  lost_at_second_ = lost_;
}

LinkHealth LinkStatistics::health(Time now, const rosflight::DecoderCounts& counts, Time round_trip) const {
  return {.frame_rate = frame_rate_,
          .byte_rate = byte_rate_,
          .loss = loss_,
          .bytes = counts.bytes,
          .lost = lost_,
          .corrupted = counts.corrupted,
          .foreign = counts.foreign,
          .unsent = unsent_,
          .age = last_frame_ ? now - *last_frame_ : Time::max(),
          .round_trip = round_trip};
}

}  // namespace ironbird::hil_bridge
