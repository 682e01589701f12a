#include "scenarios/requirements/difference_metrics.hpp"

#include <limits>

namespace ironbird::scenarios {

std::vector<Metric> difference_metrics(const std::string& whose) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const std::string than = "root mean square of the difference to " + whose + ", ";
  return {{"horizontal_difference_rms_m", kUnknown, "m", than + "distance on the map"},
          {"north_difference_rms_m", kUnknown, "m", than + "north"},
          {"east_difference_rms_m", kUnknown, "m", than + "east"},
          {"down_difference_rms_m", kUnknown, "m", than + "down, its mean taken off"},
          {"velocity_difference_rms_mps", kUnknown, "m/s", than + "velocity, three axes together"},
          {"roll_difference_rms_deg", kUnknown, "deg", than + "roll"},
          {"pitch_difference_rms_deg", kUnknown, "deg", than + "pitch"},
          {"heading_difference_rms_deg", kUnknown, "deg", than + "heading"},
          {"compared_share", kUnknown, "1",
           "of what " + whose +
               " believed in the window, how much could be compared; of attitude, position, height and "
               "velocity the least"}};
}

}  // namespace ironbird::scenarios
