#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "autopilot/estimator/ekf.hpp"
#include "autopilot/estimator/error_state_filter.hpp"
#include "autopilot/estimator/test/fake_flight.hpp"

namespace ironbird::autopilot {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// What both filters must do, on the default parameters and the noise of FakeErrors.
inline constexpr double kGoodPosition = 1.0;  // m, receiver with 0.05 m white error and a slow one of none
inline constexpr double kGoodSpeed = 0.15;    // m/s, ten times the Doppler noise
inline constexpr double kGoodAngle = 0.03;    // rad

enum class Kind { kEkf, kErrorState };

/// The number that the filter tells under this name; NaN when it tells none.
inline double probed(const AidedEstimator& filter, const std::string& wanted) {
  struct Finder final : ProbeVisitor {
    std::string wanted;
    double found = kNan;
    void operator()(std::string_view name, double value, std::string_view) override {
      if (name == wanted) found = value;
    }
    void operator()(std::string_view, const Vector3&, std::string_view) override {}
  } finder;
  finder.wanted = wanted;
  filter.probe(finder);
  return finder.found;
}

class FilterTest : public ::testing::TestWithParam<Kind> {
 protected:
  FilterTest() { make(AidingParams{}, true); }

  /// @param plain  the kind's own defaults, only the declination set
  void make(const AidingParams& aiding, bool plain) {
    if (GetParam() == Kind::kEkf) {
      auto filter = std::make_unique<Ekf>();
      EkfParams params;
      if (!plain) params.aiding = aiding;
      params.aiding.mag.declination = sensors.declination;
      filter->set_params(params);
      estimator = std::move(filter);
    } else {
      auto filter = std::make_unique<ErrorStateFilter>();
      ErrorStateParams params;
      if (!plain) params.aiding = aiding;
      params.aiding.mag.declination = sensors.declination;
      filter->set_params(params);
      estimator = std::move(filter);
    }
  }

  void fly(double seconds) {
    const double end = sensors.time() + seconds;
    while (sensors.time() < end) step(sensors.next());
  }

  void step(const SensorFrame& frame) {
    x = estimator->run(frame);
    ASSERT_TRUE(x.p_NB_N.allFinite() && x.v_NB_B.allFinite() && x.q_NB.coeffs().allFinite());
  }

  double position_error() const { return (x.p_NB_N - sensors.truth().p_N).norm(); }
  double horizontal_error() const { return (x.p_NB_N - sensors.truth().p_N).head<2>().norm(); }
  double speed_error() const { return (x.v_NB_N() - sensors.truth().v_N).norm(); }
  double angle_error() const { return x.q_NB.angularDistance(Quaternion(sensors.truth().R_NB)); }

  /// Who is armed is in flight, as far as a filter can know.
  static SensorFrame armed(SensorFrame frame) {
    frame.status = FcuStatus{};
    frame.status->armed = true;
    return frame;
  }
  /// Until the estimate is good, and then in flight.
  void fly_armed() {
    fly(40.0);
    step(armed(sensors.next()));
  }
  /// For so long that what fixes insist on is decided, s: more than the default of gnss.persistence.
  static constexpr double kPersistence = 3.5;
  /// No fixes for a while, s, and then ones that lie so far north, m, until it is decided who is right.
  void jump_after_pause(double pause, double north) {
    sensors.gnss_on = false;
    fly(pause);
    sensors.gnss_on = true;
    sensors.gnss_jump = {north, 0.0, 0.0};
    fly(kPersistence);
  }

  void expect_good() const {
    EXPECT_EQ(x.health, Health::kGood);
    EXPECT_LT(position_error(), kGoodPosition);
    EXPECT_LT(speed_error(), kGoodSpeed);
    EXPECT_LT(angle_error(), kGoodAngle);
  }

  double probed(const std::string& wanted) const { return autopilot::probed(*estimator, wanted); }

  Vector3 probed_vector(const std::string& wanted) const {
    struct Finder final : ProbeVisitor {
      std::string wanted;
      Vector3 found = Vector3::Constant(kNan);
      void operator()(std::string_view, double, std::string_view) override {}
      void operator()(std::string_view name, const Vector3& value, std::string_view) override {
        if (name == wanted) found = value;
      }
    } finder;
    finder.wanted = wanted;
    estimator->probe(finder);
    return finder.found;
  }

  FakeSensors sensors{7};
  std::unique_ptr<AidedEstimator> estimator;
  StateEstimate x;
};

}  // namespace ironbird::autopilot
