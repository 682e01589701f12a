#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "autopilot/estimator/ekf.hpp"
#include "autopilot/estimator/error_state_filter.hpp"
#include "autopilot/estimator/test/fake_flight.hpp"
#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {
namespace {

// Are the filters' errors as large as they say? Fifty flights with errors drawn from exactly the
// distributions that the filter assumes. The algebra is driven directly, without alignment and schedule.

constexpr int kSeeds = 50;
constexpr double kFirstCheck = 5.0;  // s
constexpr double kCheckEvery = 5.0;  // s
constexpr int kChecks = 12;
constexpr double kTwoSided95 = 1.96;
constexpr int kMostOutside =
    2;  // of twelve; with 5 % each, three or more outside happen in 2 % of correct filters

constexpr double kImuPeriod = 0.0025;
constexpr double kGnssSigma = 0.5;           // m
constexpr double kVelocitySigma = 0.05;      // m/s
constexpr double kPressureSigma = 10.0;      // Pa
constexpr double kMagSigma = 0.005;          // of the unit vector
constexpr double kGyroNoise = 0.00226;       // rad/s per sample
constexpr double kAccelerometerNoise = 0.2;  // m/s^2 per sample

const Vector3 kField_N(std::cos(1.1), 0.0, std::sin(1.1));

class TestedEkf final : public Ekf {
 public:
  static constexpr int kPositionDimensions = 2;
  using Ekf::baro_gate, Ekf::mag_gate, Ekf::position_gate, Ekf::velocity_gate;
  using Ekf::baro_model, Ekf::correct_baro, Ekf::correct_gnss, Ekf::correct_mag, Ekf::kinematics,
      Ekf::predict, Ekf::start;
};

class TestedErrorState final : public ErrorStateFilter {
 public:
  static constexpr int kPositionDimensions = 3;
  using ErrorStateFilter::baro_gate, ErrorStateFilter::mag_gate, ErrorStateFilter::position_gate,
      ErrorStateFilter::velocity_gate;
  using ErrorStateFilter::baro_model, ErrorStateFilter::correct_baro, ErrorStateFilter::correct_gnss,
      ErrorStateFilter::correct_mag, ErrorStateFilter::kinematics, ErrorStateFilter::predict,
      ErrorStateFilter::start;
};

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : generator_(seed) {}
  double operator()() {
    const double u = (static_cast<double>(generator_() >> 11) + 0.5) * 0x1.0p-53;
    const double v = (static_cast<double>(generator_() >> 11) + 0.5) * 0x1.0p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }
  Vector3 three() {
    const double x = (*this)();
    const double y = (*this)();
    return {x, y, (*this)()};
  }

 private:
  std::mt19937_64 generator_;
};

/// The hidden truth beyond the path.
struct Hidden {
  Vector3 gyro_bias = Vector3::Zero();
  Vector3 gyro_misalignment = Vector3::Zero();
  Vector3 gyro_scale = Vector3::Zero();
  Vector3 accelerometer_bias = Vector3::Zero();
  Vector3 gnss_walk = Vector3::Zero();
  double baro_walk = 0.0;
  Vector3 mag_bias = Vector3::Zero();

  /// What a gyro with these errors reads of the rate.
  Vector3 gyro_reading(const Vector3& w_B) const {
    const Matrix3 gain = Matrix3::Identity() + skew(gyro_misalignment) + Matrix3(gyro_scale.asDiagonal());
    return gain.inverse() * w_B + gyro_bias;
  }
};

AidingParams matched_aiding() {
  AidingParams aiding;
  aiding.gnss.sigma_horizontal = kGnssSigma;
  aiding.gnss.sigma_vertical = kGnssSigma;
  aiding.gnss.sigma_velocity_horizontal = kVelocitySigma;
  aiding.gnss.sigma_velocity_vertical = kVelocitySigma;
  aiding.gnss.position_gate = 0.0;
  aiding.gnss.velocity_gate = 0.0;
  aiding.baro.sigma = kPressureSigma;
  aiding.baro.gate = 0.0;
  aiding.mag.sigma = kMagSigma;
  aiding.mag.sigma_tilt = 1.0e-5;
  aiding.mag.gate = 0.0;
  aiding.initial.position = 0.5;
  aiding.initial.air_velocity = 0.2;
  // Small enough for the linearisation: g times the square of the tilt error must not show in the velocity.
  aiding.initial.air_tilt = 0.004;
  aiding.initial.air_heading = 0.004;  // as the tilt, so that the axes do not matter
  aiding.initial.air_gyro_bias = 0.001;
  return aiding;
}

void set_up(TestedEkf& filter, Hidden& hidden, Noise& noise) {
  EkfParams params;
  params.aiding = matched_aiding();
  params.noise.velocity = 0.0;
  params.noise.velocity_down = 0.0;
  params.noise.roll_pitch = 0.0;
  params.noise.heading = 0.0;
  params.noise.gyro_bias = 0.0;
  params.noise.accelerometer = kAccelerometerNoise * std::sqrt(kImuPeriod);
  params.noise.gyro = kGyroNoise * std::sqrt(kImuPeriod);
  filter.set_params(params);
  hidden.gyro_bias = 0.01 * noise.three();
}

void set_up(TestedErrorState& filter, Hidden& hidden, Noise& noise) {
  ErrorStateParams params;
  params.aiding = matched_aiding();
  params.noise.gyro_bias = 0.0;
  params.noise.accelerometer_bias = 0.0;
  params.noise.accelerometer = kAccelerometerNoise * std::sqrt(kImuPeriod);
  params.noise.gyro = kGyroNoise * std::sqrt(kImuPeriod);
  params.noise.gyro_misalignment = 0.01;
  params.noise.gyro_scale = 0.01;
  params.noise.mag = 0.01;
  params.noise.mag_time_constant = 1.0e6;  // constant
  params.noise.initial_accelerometer_bias = 0.05;
  params.noise.gnss_time_constant = 60.0;
  params.noise.baro_time_constant = 60.0;
  filter.set_params(params);
  hidden.gyro_bias = 0.01 * noise.three();
  hidden.accelerometer_bias = 0.05 * noise.three();
  hidden.gyro_misalignment = params.noise.gyro_misalignment * noise.three();
  hidden.gyro_scale = params.noise.gyro_scale * noise.three();
  hidden.mag_bias = params.noise.mag * noise.three();
}

/// A start that is wrong by a draw from the initial covariance.
StartState draw_start(const FakeTruth& truth, const Hidden& hidden, const AidingParams& aiding, Noise& noise,
                      bool euler) {
  const InitialSigmaParams& sigma = aiding.initial;
  const Vector3 angle_sigma(sigma.air_tilt, sigma.air_tilt, sigma.air_heading);
  const Vector3 angle = angle_sigma.cwiseProduct(noise.three());
  StartState start;
  start.moving = true;
  start.p_NB_N = truth.p_N + sigma.position * noise.three();
  start.q_NB =
      euler ? quaternion_NB(truth.theta + angle) : (Quaternion(truth.R_NB) * exponential(angle)).normalized();
  const Vector3 v_B = truth.R_NB.transpose() * truth.v_N + sigma.air_velocity * noise.three();
  start.v_NB_N = euler ? Vector3(start.q_NB * v_B) : Vector3(truth.R_NB * v_B);
  start.gyro_bias_B = hidden.gyro_bias + sigma.air_gyro_bias * noise.three();
  return start;
}

/// A start whose heading is what the biased compass says, on a tilt that is wrong already.
void take_heading_from_compass(StartState& start, const FakeTruth& truth, const Hidden& hidden,
                               const AidingParams& aiding, Noise& noise) {
  start.m_B = truth.R_NB.transpose() * kField_N + hidden.mag_bias;
  const Vector3 m_N = start.q_NB * start.m_B;
  const double azimuth = std::atan2(m_N.y(), m_N.x());
  const double turn = aiding.initial.air_heading * noise() - azimuth;
  start.q_NB = (Quaternion(Eigen::AngleAxisd(turn, Vector3::UnitZ())) * start.q_NB).normalized();
}

/// The square of `error` in units of its covariance.
double normalised_square(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

double nees(const TestedEkf& filter, const FakeTruth& truth, const Hidden& hidden) {
  EkfState::Vector error;
  Vector3 angle;
  for (int i = 0; i < 3; ++i) angle[i] = shortest_difference(truth.theta[i], filter.state().theta[i]);
  error << truth.p_N - filter.state().p_NB_N, truth.R_NB.transpose() * truth.v_N - filter.state().v_NB_B,
      angle, hidden.gyro_bias - filter.state().gyro_bias_B;
  return normalised_square(error, filter.covariance());
}

double nees(const TestedErrorState& filter, const FakeTruth& truth, const Hidden& hidden) {
  ErrorState x;
  x.p_NB_N = truth.p_N;
  x.v_NB_N = truth.v_N;
  x.q_NB = Quaternion(truth.R_NB);
  x.gyro_bias_B = hidden.gyro_bias;
  x.gyro_misalignment_B = hidden.gyro_misalignment;
  x.gyro_scale_B = hidden.gyro_scale;
  x.accelerometer_bias_B = hidden.accelerometer_bias;
  x.gnss_walk_N = hidden.gnss_walk;
  x.baro_walk = hidden.baro_walk;
  x.mag_bias_B = hidden.mag_bias;
  // The walks start without any variance, so the first rows are scaled before P is inverted.
  const ErrorState::Vector error = x.minus(filter.state());
  const ErrorState::Vector scale = filter.covariance().diagonal().cwiseSqrt().cwiseInverse();
  const ErrorState::Matrix correlation = scale.asDiagonal() * filter.covariance() * scale.asDiagonal();
  const ErrorState::Vector scaled = scale.cwiseProduct(error);
  return normalised_square(scaled, correlation);
}

/// Sums over the seeds at one check time.
struct Sums {
  double nees = 0.0, position = 0.0, velocity = 0.0, baro = 0.0, mag = 0.0;
};

void walk(Hidden&, const TestedEkf&, Noise&) {}
void walk(Hidden& hidden, const TestedErrorState& filter, Noise& noise) {
  const ErrorStateNoiseParams& q = filter.params().noise;
  const double kept = std::exp(-kImuPeriod / q.gnss_time_constant);
  const Vector3 sigma(q.gnss_horizontal, q.gnss_horizontal, q.gnss_vertical);
  hidden.gnss_walk =
      kept * hidden.gnss_walk + std::sqrt(1.0 - kept * kept) * sigma.cwiseProduct(noise.three());
  const double kept_baro = std::exp(-kImuPeriod / q.baro_time_constant);
  hidden.baro_walk = kept_baro * hidden.baro_walk + q.baro * std::sqrt(1.0 - kept_baro * kept_baro) * noise();
}

template <class Filter>
void correct_all(Filter& filter, const FakeTruth& truth, const Hidden& hidden, Noise& noise, int tick) {
  if (tick % 8 == 0) {
    const Vector3 m_B = truth.R_NB.transpose() * kField_N + hidden.mag_bias + kMagSigma * noise.three();
    filter.correct_mag(m_B.normalized(), Time{0});
  }
  if (tick % 8 == 4) {
    const double difference = filter.baro_model().pressure_difference(truth.p_N.z()) + hidden.baro_walk;
    filter.correct_baro(difference + kPressureSigma * noise(), Time{0});
  }
  if (tick % 40 != 0) return;
  GnssObservation fix;
  fix.p_N = truth.p_N + hidden.gnss_walk + kGnssSigma * noise.three();
  fix.v_N = truth.v_N + kVelocitySigma * noise.three();
  fix.dp_N = fix.p_N - filter.kinematics().p_N;
  fix.dv_N = fix.v_N - filter.kinematics().v_N;
  fix.variance_p.setConstant(kGnssSigma * kGnssSigma);
  fix.gate_variance_p = fix.variance_p;
  fix.variance_v.setConstant(kVelocitySigma * kVelocitySigma);
  filter.correct_gnss(fix, Time{0});
}

template <class Filter>
std::vector<Sums> fly_all(bool euler) {
  std::vector<Sums> sums(kChecks);
  for (int seed = 0; seed < kSeeds; ++seed) {
    Noise noise(1000 + seed);
    Filter filter;
    Hidden hidden;
    set_up(filter, hidden, noise);
    FakePath path;
    path.rest = -10.0;
    const AidingParams& aiding = filter.params().aiding;
    StartState start = draw_start(path.at(0.0), hidden, aiding, noise, euler);
    if (!euler && seed % 2 == 0) take_heading_from_compass(start, path.at(0.0), hidden, aiding, noise);
    filter.start(start);
    int check = 0;
    for (int tick = 1; check < kChecks; ++tick) {
      const double t = tick * kImuPeriod;
      // The held sample stands for the whole step, so it is the middle's: no discretisation error to speak
      // of.
      const FakeTruth middle = path.at(t - 0.5 * kImuPeriod);
      const Vector3 f_B = middle.R_NB.transpose() * (middle.a_N - 9.81 * Vector3::UnitZ());
      filter.predict(f_B + hidden.accelerometer_bias + kAccelerometerNoise * noise.three(),
                     hidden.gyro_reading(middle.w_B) + kGyroNoise * noise.three(), kImuPeriod);
      walk(hidden, filter, noise);
      const FakeTruth truth = path.at(t);
      correct_all(filter, truth, hidden, noise, tick);
      if (t < kFirstCheck + check * kCheckEvery - 0.5 * kImuPeriod) continue;
      Sums& sum = sums[check++];
      sum.nees += nees(filter, truth, hidden);
      sum.position += filter.position_gate().nis();
      sum.velocity += filter.velocity_gate().nis();
      sum.baro += filter.baro_gate().nis();
      sum.mag += filter.mag_gate().nis();
    }
  }
  return sums;
}

/// The mean over the seeds is chi-square distributed over kSeeds; its band is that of the normal
/// approximation.
void expect_in_band(const std::vector<Sums>& sums, double Sums::*member, int dimensions, const char* name) {
  const double half_width = kTwoSided95 * std::sqrt(2.0 * dimensions / kSeeds);
  int outside = 0;
  double total = 0.0;
  for (const Sums& sum : sums) {
    const double mean = sum.*member / kSeeds;
    total += mean / kChecks;
    if (std::abs(mean - dimensions) > half_width) ++outside;
  }
  ::testing::Test::RecordProperty(name, std::to_string(total));
  EXPECT_LE(outside, kMostOutside) << name << ", mean " << total << " of " << dimensions;
  EXPECT_NEAR(total, dimensions, half_width) << name;
}

template <class Filter>
void expect_consistent(bool euler, int size) {
  const std::vector<Sums> sums = fly_all<Filter>(euler);
  expect_in_band(sums, &Sums::nees, size, "nees");
  expect_in_band(sums, &Sums::position, Filter::kPositionDimensions, "nis_position");
  expect_in_band(sums, &Sums::velocity, 3, "nis_velocity");
  expect_in_band(sums, &Sums::baro, 1, "nis_baro");
  expect_in_band(sums, &Sums::mag, 1, "nis_mag");
}

TEST(EkfConsistencyTest, NeesAndNisStayInTheirBands) {
  expect_consistent<TestedEkf>(/*euler=*/true, EkfState::kSize);
}

TEST(ErrorStateConsistencyTest, NeesAndNisStayInTheirBands) {
  expect_consistent<TestedErrorState>(/*euler=*/false, ErrorState::kSize);
}

}  // namespace
}  // namespace ironbird::autopilot
