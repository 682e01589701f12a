#include "scenarios/bench/tick_rules.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>

#include "scenarios/config/file_search.hpp"
#include "scenarios/config/shortest.hpp"
#include "simulator/sensors/schedule.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kTick = "fcu.tick";
constexpr std::int64_t kMicrosecond = 1000;  // ns; the firmware's clock counts them
constexpr double kRounding = 1e-9;           // of a period in seconds

/// What has to last a whole number of ticks.
struct Span {
  std::string path;
  double length = 0.0;     ///< ns
  double tolerance = 0.0;  ///< of the length
};

void add_latencies(const FcuConfig& fcu, std::vector<Span>& spans) {
  spans.push_back({"fcu.uplink_latency", static_cast<double>(fcu.uplink_latency.count())});
  spans.push_back({"fcu.downlink_latency", static_cast<double>(fcu.downlink_latency.count())});
}

std::vector<Span> spans(const Scenario& scenario) {
  std::vector<Span> spans;
  simulator::SensorSuiteParams::describe(
      scenario.sensors, [&](const char* name, const auto& sensor, const auto&...) {
        if (sensor.timing.enabled)
          spans.push_back({std::string("sensors.") + name + ".timing.rate", 1e9 / sensor.timing.rate,
                           simulator::kRateTolerance});
      });
  const FcuConfig& fcu = scenario.fcu;
  // A unit of its own has its own radio and line.
  if (!fcu.has_own_unit()) return spans;
  spans.push_back({"fcu.rc_rate", 1e9 / fcu.rc_rate, FcuConfig::kRcTolerance});
  add_latencies(fcu, spans);
  return spans;
}

bool is_whole(const Span& span, std::int64_t tick) {
  const double ticks = span.length / static_cast<double>(tick);
  return std::abs(ticks - std::round(ticks)) <= span.tolerance * ticks;
}

/// What the span is meant to last, ns: a rate written by hand hits no period exactly.
std::int64_t meant(const Span& span) {
  const double microseconds = std::round(span.length / kMicrosecond);
  const bool is_near = std::abs(span.length - microseconds * kMicrosecond) <= span.tolerance * span.length;
  return std::llround(is_near ? microseconds * kMicrosecond : span.length);
}

std::chrono::nanoseconds to_nanosecond(double nanoseconds) {
  return std::chrono::nanoseconds(std::llround(nanoseconds));
}

/// The tick nearest to `wanted` that divides all spans, ns.
std::optional<std::int64_t> fitting_tick(const std::vector<Span>& spans, std::int64_t wanted) {
  std::int64_t whole = 0;
  for (const Span& span : spans) whole = std::gcd(whole, meant(span));
  std::optional<std::int64_t> best;
  for (std::int64_t parts = 1; whole / parts >= FcuConfig::kLeastTick.count(); ++parts) {
    const std::int64_t tick = whole / parts;
    if (whole % (parts * kMicrosecond) != 0 || tick > FcuConfig::kGreatestTick.count()) continue;
    if (!best || std::abs(tick - wanted) < std::abs(*best - wanted)) best = tick;
  }
  return best;
}

/// What is written down, or delayed, in the ticks of a run.
std::vector<Span> in_ticks(const Scenario& scenario) {
  std::vector<Span> spans{{"record.state_period", 1e9 * scenario.record.state_period, kRounding},
                          {"record.signal_period", 1e9 * scenario.record.signal_period, kRounding}};
  if (scenario.fcu.has_own_unit()) add_latencies(scenario.fcu, spans);
  return spans;
}

/// The nearest lengths that a span may have, as a user writes them.
std::string whole_lengths(const Span& span, std::int64_t tick) {
  const auto below = static_cast<std::int64_t>(span.length) / tick * tick;
  const std::string above = in_milliseconds(std::chrono::nanoseconds(below + tick));
  return below > 0 ? in_milliseconds(std::chrono::nanoseconds(below)) + " or " + above : above;
}

}  // namespace

std::string in_milliseconds(std::chrono::nanoseconds time) {
  return shortest(static_cast<double>(time.count()) / 1e6) + " ms";
}

bool tick_is_to_blame(const LoadedScenario& loaded, const std::string& path) {
  const std::string vehicle = readable(loaded.vehicle_path).string() + "/";
  const auto is_vehicles = [&](const std::string& of) {
    const auto place = loaded.places.find(of);
    return place == loaded.places.end() || place->second.starts_with(vehicle);
  };
  return !is_vehicles(kTick) && is_vehicles(path);
}

std::vector<std::string> whole_tick_findings(const LoadedScenario& loaded) {
  const std::int64_t tick = loaded.scenario.fcu.tick.count();
  std::vector<std::string> findings;
  if (tick <= 0) return findings;
  for (const Span& span : in_ticks(loaded.scenario)) {
    const bool others_fault = !loaded.gives(span.path) || tick_is_to_blame(loaded, span.path);
    if (others_fault || is_whole(span, tick)) continue;
    findings.push_back(span.path + " = " + in_milliseconds(to_nanosecond(span.length)) +
                       ": must be a whole number of ticks of " + in_milliseconds(loaded.scenario.fcu.tick) +
                       "; take " + whole_lengths(span, tick));
  }
  return findings;
}

std::vector<std::string> tick_findings(const LoadedScenario& loaded) {
  const std::int64_t tick = loaded.scenario.fcu.tick.count();
  // A real vehicle has neither simulated sensors nor a simulated radio.
  if (tick <= 0 || loaded.scenario.fcu.kind == FcuKind::kSerial) return {};
  const std::vector<Span> all = spans(loaded.scenario);
  std::vector<Span> misfits;
  std::copy_if(all.begin(), all.end(), std::back_inserter(misfits), [&](const Span& span) {
    return !is_whole(span, tick) && tick_is_to_blame(loaded, span.path);
  });
  if (misfits.empty()) return {};
  const Span& first = misfits.front();
  const auto place = loaded.places.find(first.path);
  const auto remedy = fitting_tick(all, tick);
  return {std::string(kTick) + " = " + in_milliseconds(loaded.scenario.fcu.tick) + ": must divide " +
          in_milliseconds(to_nanosecond(first.length)) + " of " + first.path +
          (place == loaded.places.end() ? "" : " (" + place->second + ")") +
          (misfits.size() > 1 ? ", and " + std::to_string(misfits.size() - 1) + " more" : "") +
          (remedy ? "; take " + in_milliseconds(std::chrono::nanoseconds(*remedy)) : "")};
}

}  // namespace ironbird::scenarios
