#pragma once

#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "autopilot/signals.hpp"
#include "scenarios/config/toml_reader.hpp"
#include "scenarios/requirements/check.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

inline constexpr double kRoundOff = 1e-9;
inline constexpr double kTick = 0.01;  // s
inline constexpr double kDegree = std::numbers::pi / 180.0;

/// Reads a check as a scenario file gives it.
inline CheckConfig from_toml(std::string_view text) {
  CheckConfig config;
  read_toml(toml::parse(text), config);
  return config;
}

/// Runs one check over ten seconds of signals given by a function of time.
class CheckTest : public ::testing::Test {
 protected:
  CheckTest() {
    table_.add("truth", truth_);
    table_.add("autopilot", signals_);
  }

  CheckResult run(std::string_view toml, const std::function<void(double)>& set) {
    Check check(from_toml(toml), {&table_, &signals_, kTick});
    for (int i = 0; i <= 1000; ++i) {
      const double t = i * kTick;
      for (const RunEvent& event : script_) {
        if (std::abs(event.time - t) < kTick / 2.0) timeline_.add(t, event.kind, event.text);
      }
      set(t);
      check.observe(t, timeline_);
    }
    return check.result({timeline_, metrics_});
  }
  /// North position as a function of time.
  CheckResult north(std::string_view toml, const std::function<double(double)>& x) {
    return run("signal = 'truth.p_NB_N.x'\n" + std::string(toml),
               [&](double t) { truth_.p_NB_N.x() = x(t); });
  }
  void expect(const CheckResult& result, Outcome outcome, double margin, double time) const {
    EXPECT_EQ(name_of(result.outcome), name_of(outcome)) << result.explanation;
    EXPECT_NEAR(result.margin, margin, kRoundOff) << result.explanation;
    EXPECT_NEAR(result.time, time, kRoundOff) << result.explanation;
    EXPECT_FALSE(result.explanation.empty());
  }
  std::string refusal(std::string_view toml) {
    try {
      const Check check(from_toml(toml), {&table_, &signals_, kTick});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  simulator::Truth truth_;
  autopilot::Signals signals_;
  SignalTable table_;
  Timeline timeline_;
  std::vector<RunEvent> script_;
  std::vector<Metric> metrics_;
};

}  // namespace ironbird::scenarios
