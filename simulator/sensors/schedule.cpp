#include "simulator/sensors/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>

namespace ironbird::simulator {

namespace {

constexpr double kNanosecondsPerSecond = 1e9;

}  // namespace

Time sample_period(double rate, Time tick, const std::string& path) {
  const double tick_rate = kNanosecondsPerSecond / static_cast<double>(tick.count());
  const double ticks = tick_rate / rate;
  const std::int64_t nearest = std::max<std::int64_t>(1, std::llround(ticks));
  if (std::abs(ticks - static_cast<double>(nearest)) <= kRateTolerance * ticks) return nearest * tick;

  const double below = std::max(1.0, std::floor(ticks));
  std::ostringstream message;
  message << path << " = " << rate << " Hz, must divide the tick's " << tick_rate << " Hz: take "
          << tick_rate / below;
  if (ticks > 1.0) message << " Hz or " << tick_rate / (below + 1.0);
  message << " Hz";
  throw std::invalid_argument(message.str());
}

Time whole_ticks(double latency, Time tick) {
  return std::llround(latency * kNanosecondsPerSecond / static_cast<double>(tick.count())) * tick;
}

}  // namespace ironbird::simulator
