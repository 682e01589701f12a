#include <benchmark/benchmark.h>

#include <chrono>

#include "ci/yardstick/in_turns.hpp"
#include "scenarios/requirements/judge.hpp"

namespace ironbird::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kTick = 2500us;

/// A vehicle in the middle of its mission: every metric is at work.
struct Flight {
  simulator::Truth truth;
  autopilot::Signals signals;

  Flight() {
    signals.flight.phase = autopilot::FlightPhase::kOffboard;
    signals.flight.fcu.armed = true;
    signals.trajectory.valid = true;
    signals.trajectory.reached = 1;
    for (int i = 0; i < 4; ++i) {
      autopilot::Waypoint waypoint;
      waypoint.p_N = Eigen::Vector3d(-20.0 * i, 10.0 * (i % 2), -5.0);
      signals.route.waypoints.push_back(waypoint);
    }
  }
};

void MetricsOfATickBesideRk4(benchmark::State& state) {
  Flight flight;
  RunMetrics metrics({&flight.truth, &flight.signals});
  std::chrono::nanoseconds now{0};
  yardstick::beside_rk4(state, 0.0, [&] { metrics.observe(now += kTick); });
}
BENCHMARK(MetricsOfATickBesideRk4)->UseManualTime();

void JudgeOfATickBesideRk4(benchmark::State& state) {
  Flight flight;
  SignalTable table;
  table.add("truth", flight.truth);
  table.add("autopilot", flight.signals);
  CheckConfig tube;
  tube.signal = "truth.p_NB_N";
  tube.stays_within_tube = "0.5 m";
  CheckConfig error;
  error.error = {"truth.p_NB_N", "autopilot.estimate.p_NB_N"};
  error.rms_below = "1 m";
  CheckConfig phase;
  phase.never_happens = "autopilot.flight.phase == landing";
  const std::vector<CheckConfig> kinds{tube, error, phase};
  std::vector<CheckConfig> checks;
  for (int i = 0; i < state.range(0); ++i)
    checks.push_back(kinds[static_cast<std::size_t>(i) % kinds.size()]);
  Judge judge(checks, table, {&flight.truth, &flight.signals}, kTick);
  std::chrono::nanoseconds now{0};
  yardstick::beside_rk4(state, 0.0, [&] { judge.observe(now += kTick); });
}
BENCHMARK(JudgeOfATickBesideRk4)->Arg(0)->Arg(3)->Arg(9)->UseManualTime();

}  // namespace
}  // namespace ironbird::scenarios
