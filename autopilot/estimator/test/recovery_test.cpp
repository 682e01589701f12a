#include <gtest/gtest.h>

#include <limits>

#include "autopilot/estimator/aided_estimator.hpp"
#include "autopilot/estimator/test/fake_flight.hpp"

namespace ironbird::autopilot {
namespace {

/// A filter without algebra: its state is what it was started with, and it breaks on command.
class BrittleFilter final : public AidedEstimator {
 public:
  bool broken = false;
  int starts = 0;
  StartState started;
  GnssObservation last_fix;

 protected:
  const AidingParams& aiding() const override { return aiding_; }
  void start(const StartState& start) override {
    ++starts;
    started = start;
    broken = false;
  }
  void predict(const Vector3&, const Vector3&, double) override {}
  void correct_mag(const Vector3&, Time) override {}
  void correct_baro(double, Time) override {}
  void correct_gnss(const GnssObservation& fix, Time) override { last_fix = fix; }
  void doubt_heading(double) override {}
  Kinematics kinematics() const override { return {started.p_NB_N, started.v_NB_N}; }
  bool is_finite() const override { return !broken; }
  void publish(StateEstimate& x) const override {
    x.p_NB_N = started.p_NB_N;
    x.q_NB = started.q_NB;
    x.v_NB_B = started.q_NB.conjugate() * started.v_NB_N;
  }
  void probe_filter(ProbeVisitor&) const override {}

 private:
  AidingParams aiding_;
};

TEST(RecoveryTest, RebuildsTheStateFromTheLastFixInTheRightFrames) {
  // GIVEN a filter in flight, with a heading that tells N from B
  FakeSensors sensors(5);
  BrittleFilter filter;
  while (sensors.time() < 20.0) filter.run(sensors.next());
  ASSERT_EQ(filter.starts, 1);
  // WHEN its state is no number
  filter.broken = true;
  const StateEstimate x = filter.run(sensors.next());
  // THEN it starts again with velocity and position in N, height and attitude of the last good estimate
  EXPECT_EQ(filter.starts, 2);
  EXPECT_EQ(filter.recoveries(), 1);
  EXPECT_LT((filter.started.v_NB_N - filter.last_fix.v_N).norm(), 1.0e-9);
  EXPECT_LT((filter.started.p_NB_N - filter.last_fix.p_N).head<2>().norm(), 1.0e-9);
  EXPECT_NEAR(filter.started.p_NB_N.z(), 0.0, 1.0);
  constexpr double kOneFixPeriod = 0.1;  // s
  EXPECT_LT((x.v_NB_N() - sensors.truth().v_N).norm(), 0.1 + kOneFixPeriod * sensors.truth().a_N.norm());
}

}  // namespace
}  // namespace ironbird::autopilot
