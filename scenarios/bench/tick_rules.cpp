#include "scenarios/bench/tick_rules.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>

#include "scenarios/config/file_search.hpp"
#include "scenarios/config/shortest.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kTick = "fcu.tick";
// ns; the bounds of fcu.tick, and the firmware's clock counts microseconds.
constexpr std::int64_t kLeastTick = 100'000;
constexpr std::int64_t kGreatestTick = 20'000'000;
constexpr std::int64_t kMicrosecond = 1000;
/// A rate written by hand, for example 133.333 Hz, means the period it rounds to.
constexpr double kRateTolerance = 1e-5;

/// What has to last a whole number of ticks.
struct Span {
  std::string path;
  double length = 0.0;  ///< ns
};

std::vector<Span> spans(const Scenario& scenario) {
  std::vector<Span> spans;
  simulator::SensorSuiteParams::describe(
      scenario.sensors, [&](const char* name, const auto& sensor, const auto&...) {
        if (sensor.timing.enabled)
          spans.push_back({std::string("sensors.") + name + ".timing.rate", 1e9 / sensor.timing.rate});
      });
  const FcuConfig& fcu = scenario.fcu;
  spans.push_back({"fcu.rc_rate", 1e9 / fcu.rc_rate});
  spans.push_back({"fcu.uplink_latency", static_cast<double>(fcu.uplink_latency.count())});
  spans.push_back({"fcu.downlink_latency", static_cast<double>(fcu.downlink_latency.count())});
  return spans;
}

bool is_whole(const Span& span, std::int64_t tick) {
  const double ticks = span.length / static_cast<double>(tick);
  return std::abs(ticks - std::round(ticks)) <= kRateTolerance * ticks;
}

std::string in_milliseconds(double nanoseconds) {
  return shortest(std::round(nanoseconds) / 1e6) + " ms";
}

/// The tick nearest to `wanted` that divides all spans, ns.
std::optional<std::int64_t> fitting_tick(const std::vector<Span>& spans, std::int64_t wanted) {
  std::int64_t whole = 0;
  for (const Span& span : spans)
    whole = std::gcd(whole, static_cast<std::int64_t>(std::llround(span.length)));
  std::optional<std::int64_t> best;
  for (std::int64_t parts = 1; whole / parts >= kLeastTick; ++parts) {
    const std::int64_t tick = whole / parts;
    if (whole % (parts * kMicrosecond) != 0 || tick > kGreatestTick) continue;
    if (!best || std::abs(tick - wanted) < std::abs(*best - wanted)) best = tick;
  }
  return best;
}

}  // namespace

bool tick_is_to_blame(const LoadedScenario& loaded, const std::string& path) {
  const std::string vehicle = readable(loaded.vehicle_path).string() + "/";
  const auto is_vehicles = [&](const std::string& of) {
    const auto place = loaded.places.find(of);
    return place == loaded.places.end() || place->second.starts_with(vehicle);
  };
  return !is_vehicles(kTick) && is_vehicles(path);
}

std::vector<std::string> tick_findings(const LoadedScenario& loaded) {
  const std::int64_t tick = loaded.scenario.fcu.tick.count();
  if (tick <= 0) return {};
  const std::vector<Span> all = spans(loaded.scenario);
  std::vector<Span> misfits;
  std::copy_if(all.begin(), all.end(), std::back_inserter(misfits), [&](const Span& span) {
    return !is_whole(span, tick) && tick_is_to_blame(loaded, span.path);
  });
  if (misfits.empty()) return {};
  const Span& first = misfits.front();
  const auto place = loaded.places.find(first.path);
  const auto remedy = fitting_tick(all, tick);
  return {std::string(kTick) + " = " + in_milliseconds(static_cast<double>(tick)) + ": must divide " +
          in_milliseconds(first.length) + " of " + first.path +
          (place == loaded.places.end() ? "" : " (" + place->second + ")") +
          (misfits.size() > 1 ? ", and " + std::to_string(misfits.size() - 1) + " more" : "") +
          (remedy ? "; take " + in_milliseconds(static_cast<double>(*remedy)) : "")};
}

}  // namespace ironbird::scenarios
