#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

#include "ci/yardstick/hand_written_rk4.hpp"

namespace ironbird::yardstick {

/// CPU time of this thread, s.
inline double cpu_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// How two pieces of work are compared.
struct Turns {
  double goal = 0.0;    ///< the ratio that is promised; 0 when none is
  int batch = 1;        ///< calls in one turn
  double pieces = 1.0;  ///< of work in one call, of either; the times are of one piece
};

/// Lets `ours` and `yardstick` take turns, so that what loads the machine loads both. The counters are
/// medians over the rounds: `ns` and `yardstick_ns` of one piece, `ratio` of each round's two. To be
/// registered with UseManualTime().
/// @param prepare  called before each round, not timed
template <class Ours, class Yardstick, class Prepare>
void in_turns(benchmark::State& state, const Turns& turns, Ours&& ours, Yardstick&& yardstick,
              Prepare&& prepare) {
  std::vector<double> ours_s;
  std::vector<double> yardstick_s;
  std::vector<double> ratio;
  for (auto _ : state) {
    prepare();
    const double start = cpu_now();
    for (int i = 0; i < turns.batch; ++i) ours();
    const double half = cpu_now();
    for (int i = 0; i < turns.batch; ++i) yardstick();
    const double end = cpu_now();
    ours_s.push_back(half - start);
    yardstick_s.push_back(end - half);
    ratio.push_back(ours_s.back() / yardstick_s.back());
    state.SetIterationTime(half - start);
  }
  if (ratio.empty()) return;
  const double to_ns = 1e9 / (turns.batch * turns.pieces);
  state.counters["ns"] = to_ns * median(ours_s);
  state.counters["yardstick_ns"] = to_ns * median(yardstick_s);
  state.counters["ratio"] = median(ratio);
  if (turns.goal > 0.0) state.counters["goal"] = turns.goal;
}

/// The same beside a step of the hand-written integrator.
template <class Ours>
void beside_rk4(benchmark::State& state, double goal, Ours&& ours) {
  constexpr int kBatch = 400;       // calls, so that the clock's own cost does not count
  constexpr double kTick = 2.5e-3;  // s
  HandWrittenRk4 rk4;
  in_turns(
      state, {.goal = goal, .batch = kBatch}, ours, [&] { rk4.step(kTick); }, [] {});
  benchmark::DoNotOptimize(rk4.state().data());
}

}  // namespace ironbird::yardstick
