#pragma once

#include <cstddef>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"
#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::scenarios {

/// What an IMU measured in the time before a stamp, in B: specific force m/s^2, rate rad/s.
struct ImuSample {
  hil_bridge::Time when{};
  hil_bridge::Time length{};  ///< over which it is the mean; zero: not told
  autopilot::Vector3 force = autopilot::Vector3::Zero();
  autopilot::Vector3 rate = autopilot::Vector3::Zero();

  bool is_finite() const { return force.allFinite() && rate.allFinite(); }
};

/// Puts in the samples that a logger left out, of which at most five in a row may be missing; a longer gap is
/// a gap. @param samples  rising in time. @return how many were put in
///
/// Each is foretold from up to four samples on either side, by weights that foretell best what the same
/// flight has where nothing is missing (least squares for each axis; N. Wiener, Extrapolation, Interpolation,
/// and Smoothing of Stationary Time Series, 1949). On a vehicle that shakes near half the sampling rate the
/// samples alternate, and the mean of two neighbours is further off than no sample. The weights sum to one:
/// what does not change is kept. A flight too short to learn from is bridged by straight lines.
std::size_t fill_gaps(std::vector<ImuSample>& samples);

}  // namespace ironbird::scenarios
