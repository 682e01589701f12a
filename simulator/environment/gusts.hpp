#pragma once

#include <array>
#include <cstdint>

#include "simulator/random/stream.hpp"
#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Single gusts that come at random and add up.
struct GustParams {
  double amplitude = 0.0;
  double amplitude_spread = 0.0;
  double mean_interval = 5.0;
  double shortest = 0.5;
  double longest = 5.0;
  double direction_spread = 0.1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("amplitude", self.amplitude, "m/s", "mean of a gust's peak speed", -50.0, 50.0);
    visit("amplitude_spread", self.amplitude_spread, "m/s", "standard deviation of the peak speed", 0.0,
          50.0);
    visit("mean_interval", self.mean_interval, "s", "mean time between two beginnings", 1e-3, 1e6);
    visit("shortest", self.shortest, "s", "least duration of a gust", 1e-3, 1e4);
    visit("longest", self.longest, "s", "greatest duration of a gust", 1e-3, 1e4);
    visit("direction_spread", self.direction_spread, "1",
          "standard deviation, per axis, of what is added to the unit vector of the mean wind to find a "
          "gust's direction",
          0.0, 10.0);
  }
};

/// Gusts of the shape amplitude/2 (1 - cos(2 pi t/duration)), beginning as a Poisson process.
///
/// The beginnings are drawn in continuous time, so a gust does not depend on how the time is cut into steps.
/// A gust that would be the ninth at once is left out. Shape: MIL-F-8785C, section 3.7.2.3, closed by its
/// mirror image.
class Gusts {
 public:
  /// @param mean_wind_N  gives the direction; without wind every direction is as likely as any other
  Gusts(const GustParams& params, const Vector3& mean_wind_N, std::uint64_t seed);

  /// Moves on by `dt`, s, >= 0.
  void advance(double dt);

  /// The sum of all gusts now, m/s.
  const Vector3& wind_N() const { return wind_N_; }

 private:
  struct Gust {
    double begin = 0.0;
    double duration = 0.0;  // s; 0: free place
    Vector3 peak_N = Vector3::Zero();
  };
  static constexpr int kMostAtOnce = 8;

  void begin_gust(double begin);

  GustParams params_;
  Vector3 direction_N_;
  Stream arrivals_;
  Stream shapes_;
  bool active_;
  double now_ = 0.0;
  double next_ = 0.0;
  std::array<Gust, kMostAtOnce> gusts_{};
  Vector3 wind_N_ = Vector3::Zero();
};

}  // namespace ironbird::simulator
