#pragma once

#include <cstddef>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"
#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::scenarios {

/// What an IMU measured in the time before a stamp.
struct RecordedImuSample {
  hil_bridge::Time stamp{};
  hil_bridge::Time length{};
  autopilot::Vector3 f_B = autopilot::Vector3::Zero();
  autopilot::Vector3 w_NB_B = autopilot::Vector3::Zero();

  bool is_finite() const { return f_B.allFinite() && w_NB_B.allFinite(); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "the end of the sample");
    visit("length", self.length, "ns", "over which it is the mean; zero: not told");
    visit("f_B", self.f_B, "m/s^2", "specific force");
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity of B in N");
  }
};

/// Puts in the samples that a logger left out, of which at most five in a row may be missing; a longer gap is
/// a gap. @param samples  rising in time. @return how many were put in
///
/// Each is foretold from up to four recorded samples on either side, by weights that foretell best what the
/// same flight has where nothing is missing (least squares for each axis; N. Wiener, Extrapolation,
/// Interpolation, and Smoothing of Stationary Time Series, 1949). On a vehicle that shakes near half the
/// sampling rate the samples alternate, and the mean of two neighbours is further off than no sample. The
/// weights sum to one: what does not change is kept. Moments much louder than the flight's median count for
/// less. Fewer samples are asked where there is too little to learn four from, and at last a straight line.
/// Samples of up to four periods later are used, which a filter in flight would not have.
std::size_t fill_gaps(std::vector<RecordedImuSample>& samples);

}  // namespace ironbird::scenarios
