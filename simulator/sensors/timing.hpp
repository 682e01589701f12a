#pragma once

namespace ironbird::simulator {

/// When a sensor samples and how late its readings arrive.
struct TimingParams {
  bool enabled = true;
  double rate = 100.0;
  double latency = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("enabled", self.enabled, "1", "the vehicle carries this sensor");
    visit("rate", self.rate, "Hz", "samples per second; the period is a whole number of ticks", 1e-3, 1e5);
    visit("latency", self.latency, "s", "from sample to arrival; rounded to whole ticks", 0.0, 10.0);
  }
};

}  // namespace ironbird::simulator
