#include "hil_bridge/executive/realtime.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace ironbird::hil_bridge {

Realtime::Realtime(Fcu& fcu, autopilot::Autopilot& pilot, Guard& guard, transport::ByteStream& line,
                   Clock& clock, const RealtimeConfig& config)
    : tick_(fcu, pilot, guard), line_(line), clock_(clock), config_(config) {
  if (config.period.count() <= 0) {
    throw std::invalid_argument("realtime.period = " + std::to_string(config.period.count()) +
                                " ns, must be > 0");
  }
  if (config.greatest_missed < 1) {
    throw std::invalid_argument("realtime.greatest_missed = " + std::to_string(config.greatest_missed) +
                                ", must be >= 1");
  }
  tick_.measure(clock);
}

Time Realtime::pass() {
  const Time wanted = now_ + config_.period;
  if (!first_) clock_.wait(line_.descriptor(), wanted);
  const Time now = clock_.now();
  if (!first_) count_missed(now, wanted);
  first_ = false;
  now_ = now;
  tick_.run(now, in_time());
  return now;
}

void Realtime::count_missed(Time now, Time wanted) {
  LoopTiming& timing = tick_.timing();
  ++timing.passes;
  if (now >= wanted) timing.jitter.add(now - wanted);
  // Two passes may begin up to two periods apart before one is missing between them.
  const std::int64_t missed = std::max<std::int64_t>((now - now_) / config_.period - 1, 0);
  const std::int64_t in_row = missed == 0 ? 0 : in_row_ + missed;
  in_row_ = static_cast<int>(std::min<std::int64_t>(in_row, std::numeric_limits<int>::max()));
  timing.missed += static_cast<std::uint64_t>(missed);
  timing.most_missed = std::max(timing.most_missed, static_cast<std::uint64_t>(in_row_));
}

}  // namespace ironbird::hil_bridge
