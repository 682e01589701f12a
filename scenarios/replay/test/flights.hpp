#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

// Real flights that lie beside the checkout, not in it: IRONBIRD_FLIGHTS, or ../shared/data/flights.

namespace ironbird::scenarios::test {

/// The folder of the recorded flights; empty where there is none.
inline std::filesystem::path flights_folder() {
  const char* const named = std::getenv("IRONBIRD_FLIGHTS");
  const std::filesystem::path folder =
      named != nullptr ? std::filesystem::path(named)
                       : std::filesystem::path(IRONBIRD_SOURCE_DIR) / "../shared/data/flights";
  return std::filesystem::exists(folder / "px4") ? folder : std::filesystem::path();
}

/// A PX4 log and what its folder's page says of it.
struct KnownFlight {
  const char* file;
  const char* window;       ///< s
  const char* declination;  ///< deg
  const char* mag;
};

inline const std::vector<KnownFlight> kKnownFlights = {{"h520_hexa_mission_fullrate", "2.7:59.3", "3.6", "0"},
                                                       {"x500_quad_mission_rtl", "4.8:76.1", "-10.8", "1"},
                                                       {"v6c_quad_mission_two_mags", "5.8:58.6", "4.0", "1"},
                                                       {"x8_octo_altctl", "5.2:75.7", "-3.3", "0"},
                                                       {"cube_quad_hover", "4.3:28.8", "11.3", "0"}};

}  // namespace ironbird::scenarios::test

/// Ends a test that needs the recorded flights where they are not.
#define IRONBIRD_NEEDS_FLIGHTS()                                                                         \
  if (ironbird::scenarios::test::flights_folder().empty()) {                                             \
    GTEST_SKIP() << "no recorded flights: they lie beside the checkout, or where IRONBIRD_FLIGHTS says"; \
  }
