#pragma once

#include <cstdint>
#include <string_view>

namespace ironbird::simulator {

/// A stream of random numbers that depends on the run's seed and on its own name, and on nothing else: adding
/// a sensor or reordering calls leaves every other stream as it was.
///
/// Counter-based: the n-th number is a mix of (key + n times the golden ratio). Source: Steele, Lea, Flood,
/// "Fast splittable pseudorandom number generators", 2014. Normal deviates by inversion of the distribution:
/// Wichura, algorithm AS 241, 1988.
class Stream {
 public:
  /// @param seed  of the run
  /// @param name  of the source of noise, for example "sensors/gnss/white"
  Stream(std::uint64_t seed, std::string_view name);

  /// Uniform in (0, 1): neither end is ever returned.
  double uniform();

  /// Uniform in (lower, upper).
  double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }

  /// Normal with mean 0 and standard deviation 1.
  double normal();

 private:
  std::uint64_t state_;
};

/// The x for which a standard normal deviate is below x with probability `p`. @param p  in (0, 1)
double normal_quantile(double p);

}  // namespace ironbird::simulator
