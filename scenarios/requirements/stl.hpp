#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

// Signal temporal logic on sampled margins, online. A margin is how far a proposition is from changing its
// truth value: positive when it holds, negative when it is violated. Each operator is fed sample by sample,
// in order of time, keeps a bounded amount of memory and never allocates after it is made.
//
// Source: quantitative semantics of Donzé and Maler, "Robust satisfaction of temporal logic over real-valued
// signals", 2010; a trace is finite, and an interval that holds no sample has no margin.

namespace ironbird::scenarios::stl {

/// Times that an operator looks at, s after the first sample. Both ends belong to it.
struct Interval {
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
};

/// A margin and the time of the sample that decided it.
struct Robustness {
  double margin = 0.0;
  double time = 0.0;  ///< s, as given to sample()
};

/// "p holds at every sample of the interval": the least margin.
class Always {
 public:
  explicit Always(Interval interval = {}) : interval_(interval) {}
  void sample(double time, double margin);
  /// Of the first sample; nothing while the interval holds no sample.
  std::optional<Robustness> robustness() const { return worst_; }

 private:
  Interval interval_;
  std::optional<double> start_;
  std::optional<Robustness> worst_;
};

/// "p holds at some sample of the interval": the greatest margin.
class Eventually {
 public:
  explicit Eventually(Interval interval = {}) : interval_(interval) {}
  void sample(double time, double margin);
  std::optional<Robustness> robustness() const { return best_; }

 private:
  Interval interval_;
  std::optional<double> start_;
  std::optional<Robustness> best_;
};

/// "p holds at some sample of the last `span` seconds", for every sample: the operator to put inside Always
/// for "p is never violated for longer than `span` at a stretch". Greatest margin of a sliding window.
class Recently {
 public:
  /// @param span  s, >= 0
  /// @param period  least distance of two samples, s, > 0; bounds the memory
  Recently(double span, double period);

  /// @return the greatest margin of the samples in [time - span, time]
  double sample(double time, double margin);

  /// True once the window has been open for `span`: before that, nothing can be said of a whole span.
  bool full() const { return full_; }

 private:
  struct Entry {
    double time;
    double margin;
  };

  double span_;
  std::vector<Entry> ring_;  ///< margins falling from oldest to newest
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::optional<double> start_;
  bool full_ = false;
};

/// Not p.
inline double negation(double p) {
  return -p;
}

}  // namespace ironbird::scenarios::stl
