#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "autopilot/estimator/aided_estimator.hpp"
#include "autopilot/estimator/alignment.hpp"
#include "autopilot/estimator/ekf_measurements.hpp"
#include "autopilot/estimator/ekf_process.hpp"
#include "autopilot/estimator/error_state_process.hpp"
#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kHalfPi = 0.5 * std::numbers::pi;
constexpr double kStep = 1.0e-5;  // truncation and rounding both near 1e-10 for functions of order 1
constexpr double kTolerance = 2.0e-7;

/// A point at which derivatives are taken.
struct Point {
  std::string name;
  Vector3 theta;
  Vector3 v_B;
  Vector3 w_B;
  Vector3 f_B;
};

std::vector<Point> points() {
  const Vector3 fast(12.0, -7.0, 4.0);
  const Vector3 spin(3.0, -5.0, 2.0);
  const Vector3 level(0.1, -0.2, -9.8);
  return {{"Rest", Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), level},
          {"Ordinary", {0.2, -0.1, 0.7}, {3.0, 0.5, -0.4}, {0.1, 0.3, -0.2}, level},
          {"Fast", {-0.6, 0.5, -2.9}, fast, spin, {4.0, -3.0, -19.0}},
          {"Inverted", {3.0, 0.3, 1.0}, fast, spin, {0.5, 0.2, 9.0}},
          {"Seam", {0.1, 0.1, std::numbers::pi}, fast, spin, level},
          {"Steep", {0.4, 1.45, -1.0}, fast, {0.3, 0.2, 0.1}, level},
          {"NearlySingular", {0.4, kHalfPi - 0.01, -1.0}, {1.0, 2.0, 3.0}, {0.3, 0.2, 0.1}, level}};
}

/// One model: its analytic derivative at a point, and the function itself around the point.
struct Model {
  std::string name;
  int inputs;
  std::function<Matrix(const Point&)> analytic;
  std::function<Vector(const Point&, const Vector&)> function;  ///< of the small change of its argument
};

constexpr double kGravity = 9.81;
const Vector3 kGyroBias(0.01, -0.02, 0.03);
const Vector3 kAccelerometerBias(0.05, 0.02, -0.04);
const Vector3 kGyroMisalignment(0.02, -0.01, 0.015);
const Vector3 kGyroScale(-0.01, 0.02, 0.005);
const Vector3 kMagBias(0.02, -0.03, 0.01);
const Vector3 kField = Vector3(0.41, 0.06, 0.91).normalized();  // in N

EkfState ekf_state(const Point& p) {
  return {{5.0, -3.0, -40.0}, p.v_B, p.theta, kGyroBias};
}
EkfInput input(const Point& p) {
  return {p.f_B, p.w_B, kGravity};
}
Vector3 field_B(const Point& p) {
  return rotation_NB(EulerTrig(p.theta)).transpose() * kField;
}
EulerTrig trig(const Point& p) {
  return EulerTrig(p.theta);
}

ErrorState error_state(const Point& p) {
  ErrorState x;
  x.p_NB_N = {5.0, -3.0, -40.0};
  x.q_NB = quaternion_NB(p.theta);
  x.v_NB_N = x.q_NB * p.v_B;
  x.gyro_bias_B = kGyroBias;
  x.gyro_misalignment_B = kGyroMisalignment;
  x.gyro_scale_B = kGyroScale;
  x.accelerometer_bias_B = kAccelerometerBias;
  x.gnss_walk_N = {0.4, -0.3, 0.8};
  x.baro_walk = 12.0;
  x.mag_bias_B = kMagBias;
  return x;
}

Vector dynamics_at(const EkfState::Vector& x, const EkfInput& u) {
  const EkfState state = EkfState::from(x);
  return ekf_dynamics(state, EulerTrig(state.theta), u);
}

constexpr double kErrorStep = 1.0e-3;  // s, of the error-state transition
const WalkDecay kDecay{.gnss = 0.999, .baro = 0.998, .mag = 0.997};

std::vector<Model> processes_and_measurements() {
  std::vector<Model> all;
  all.push_back(
      {"EkfDynamicsOfState", EkfState::kSize,
       [](const Point& p) -> Matrix { return ekf_jacobian(ekf_state(p), trig(p), input(p)).full(); },
       [](const Point& p, const Vector& dx) -> Vector {
         return dynamics_at(ekf_state(p).stacked() + dx, input(p));
       }});
  all.push_back({"EkfDynamicsOfNoise", 6,
                 [](const Point& p) -> Matrix { return ekf_noise_jacobian(ekf_state(p), trig(p)); },
                 [](const Point& p, const Vector& noise) -> Vector {
                   // The sensor reads truth plus noise, so truth is the reading less the noise.
                   EkfInput u = input(p);
                   u.f_B -= noise.head<3>();
                   u.w_NB_B -= noise.tail<3>();
                   return dynamics_at(ekf_state(p).stacked(), u);
                 }});
  all.push_back({"GnssVelocity", EkfState::kSize,
                 [](const Point& p) -> Matrix {
                   Matrix C = Matrix::Zero(3, EkfState::kSize);
                   C.middleCols<6>(EkfState::kVelocity) = ekf_gnss_velocity(ekf_state(p), trig(p)).C;
                   return C;
                 },
                 [](const Point& p, const Vector& dx) -> Vector {
                   const EkfState x = EkfState::from(ekf_state(p).stacked() + dx);
                   return ekf_gnss_velocity(x, EulerTrig(x.theta)).h;
                 }});
  all.push_back({"Barometer", 1,
                 [](const Point& p) -> Matrix {
                   const BaroModel baro{.density = 1.07, .density_gradient = -9.9e-5, .gravity = kGravity};
                   return Matrix::Constant(1, 1, baro.slope(ekf_state(p).p_NB_N.z()));
                 },
                 [](const Point& p, const Vector& dx) -> Vector {
                   const BaroModel baro{.density = 1.07, .density_gradient = -9.9e-5, .gravity = kGravity};
                   return Vector::Constant(1, baro.pressure_difference(ekf_state(p).p_NB_N.z() + dx(0)));
                 }});
  all.push_back({"TiltMagOfField", 3,
                 [](const Point& p) -> Matrix { return ekf_mag(field_B(p), trig(p), 0.2).F; },
                 [](const Point& p, const Vector& dm) -> Vector {
                   const double at_point = ekf_mag(field_B(p), trig(p), 0.2).y;
                   const double y = ekf_mag(field_B(p) + Vector3(dm), trig(p), 0.2).y;
                   return Vector::Constant(1, shortest_difference(y, at_point));
                 }});
  all.push_back({"TiltMagOfState", 3,
                 [](const Point& p) -> Matrix { return -ekf_mag(field_B(p), trig(p), 0.2).H(); },
                 [](const Point& p, const Vector& d_theta) -> Vector {
                   // The whole innovation y(m, Theta) - psi, whose derivative is G - C.
                   const Vector3 theta = p.theta + Vector3(d_theta);
                   const double y = ekf_mag(field_B(p), EulerTrig(theta), 0.2).y;
                   return Vector::Constant(1, shortest_difference(y, theta.z()));
                 }});
  all.push_back({"ErrorStateMag", 6,
                 [](const Point& p) -> Matrix {
                   const ErrorMagModel model = error_state_mag(error_state(p), field_B(p) - kMagBias, 0.1);
                   Matrix H(1, 6);
                   H << model.H_attitude, model.H_bias;
                   return -H;
                 },
                 [](const Point& p, const Vector& e) -> Vector {
                   ErrorState::Vector error = ErrorState::Vector::Zero();
                   error.segment<3>(ErrorState::kAttitude) = e.head<3>();
                   error.segment<3>(ErrorState::kMagBias) = e.tail<3>();
                   const ErrorState x = error_state(p).plus(error);
                   const Vector3 field = field_B(p) - x.mag_bias_B;
                   return Vector::Constant(1, error_state_mag(x, field, 0.1).innovation);
                 }});
  all.push_back({"ErrorStateTransition", ErrorState::kSize,
                 [](const Point& p) -> Matrix {
                   Matrix3 R_mid;
                   error_state_propagate(error_state(p), input(p), kDecay, kErrorStep, R_mid);
                   return error_transition(error_state(p), input(p), R_mid, kDecay, kErrorStep).full();
                 },
                 [](const Point& p, const Vector& e) -> Vector {
                   Matrix3 unused;
                   const ErrorState from = error_state(p);
                   const ErrorState to = error_state_propagate(from, input(p), kDecay, kErrorStep, unused);
                   const ErrorState moved =
                       error_state_propagate(from.plus(e), input(p), kDecay, kErrorStep, unused);
                   return moved.minus(to);
                 }});
  return all;
}

/// Of the velocity in N and in B, and of what is published from the error state.
std::vector<Model> changes_of_variables() {
  std::vector<Model> all;
  all.push_back({"EkfToVelocityInN", EkfState::kSize,
                 [](const Point& p) -> Matrix { return ekf_to_v_N(ekf_state(p), trig(p)); },
                 [](const Point& p, const Vector& dx) -> Vector {
                   EkfState::Vector x = ekf_state(p).stacked() + dx;
                   const EulerTrig at(x.segment<3>(EkfState::kAttitude));
                   const Vector3 v_B = x.segment<3>(EkfState::kVelocity);
                   x.segment<3>(EkfState::kVelocity) = rotation_NB(at) * v_B;
                   return x;
                 }});
  all.push_back({"EkfFromVelocityInN", EkfState::kSize,
                 [](const Point& p) -> Matrix { return ekf_from_v_N(ekf_state(p), trig(p)); },
                 [](const Point& p, const Vector& dx) -> Vector {
                   EkfState::Vector x = ekf_state(p).stacked() + dx;
                   const EulerTrig at(x.segment<3>(EkfState::kAttitude));
                   const Vector3 v_N =
                       rotation_NB(trig(p)) * p.v_B + Vector3(dx.segment<3>(EkfState::kVelocity));
                   x.segment<3>(EkfState::kVelocity) = rotation_NB(at).transpose() * v_N;
                   return x;
                 }});
  all.push_back({"BodyVelocityOfErrorState", 6,
                 [](const Point& p) -> Matrix {
                   return error_body_velocity(error_state(p).q_NB.toRotationMatrix(), p.v_B);
                 },
                 [](const Point& p, const Vector& e) -> Vector {
                   ErrorState::Vector error = ErrorState::Vector::Zero();
                   error.segment<6>(ErrorState::kVelocity) = e;
                   const ErrorState x = error_state(p).plus(error);
                   return x.q_NB.conjugate() * x.v_NB_N;
                 }});
  all.push_back({"AnglesOfErrorState", 3, [](const Point& p) -> Matrix { return euler_rate_matrix(trig(p)); },
                 [](const Point& p, const Vector& e) -> Vector {
                   const Quaternion q_NB = quaternion_NB(p.theta) * exponential(e);
                   const Vector3 theta = euler_from_quaternion(q_NB);
                   return theta.binaryExpr(p.theta,
                                           [](double a, double b) { return shortest_difference(a, b); });
                 }});
  return all;
}

/// The error of the attitude that the alignment finds at rest when accelerometer (first three) and compass
/// (last three) have a small bias.
Vector3 alignment_error(const Point& p, const Vector& bias) {
  const Vector3 f_B = rotation_NB(trig(p)).transpose() * Vector3(0.0, 0.0, -kGravity);
  const double declination = std::atan2(kField.y(), kField.x());
  const auto aligned = [&](const Vector3& f, const Vector3& m) {
    return attitude_from_vectors(f, Vector3::Zero(), m, declination, kGravity).q_NB;
  };
  const Quaternion found = aligned(f_B, field_B(p));
  return logarithm(found.conjugate() * aligned(f_B - bias.head<3>(), field_B(p) - bias.tail<3>()));
}

std::vector<Model> starts() {
  const auto down_B = [](const Point& p) -> Vector3 { return rotation_NB(trig(p)).row(2).transpose(); };
  const auto heading = [down_B](const Point& p) {
    const double declination = std::atan2(kField.y(), kField.x());
    return heading_start(error_state(p), field_B(p), down_B(p), declination);
  };
  std::vector<Model> all;
  all.push_back(
      {"TiltOfAlignment", 3,
       [down_B](const Point& p) -> Matrix { return tilt_from_accelerometer_bias(down_B(p), kGravity); },
       [down_B](const Point& p, const Vector& bias) -> Vector {
         Vector both = Vector::Zero(6);
         both.head<3>() = bias;
         const Vector3 error = alignment_error(p, both);
         return error - down_B(p) * down_B(p).dot(error);
       }});
  all.push_back({"AttitudeOfAlignment", 6,
                 [down_B, heading](const Point& p) -> Matrix {
                   const HeadingStart start = heading(p);
                   Matrix J(3, 6);
                   J << start.from_tilt * tilt_from_accelerometer_bias(down_B(p), kGravity), start.from_bias;
                   return J;
                 },
                 [](const Point& p, const Vector& bias) -> Vector { return alignment_error(p, bias); }});
  return all;
}

/// 1 for the rows in which the pole of the Euler angles shows: their own rates.
Vector steep_rows(const std::string& model, Eigen::Index rows) {
  Vector steep = Vector::Zero(rows);
  if (model.starts_with("EkfDynamics")) steep.segment<3>(EkfState::kAttitude).setOnes();
  if (model == "AnglesOfErrorState") steep.setOnes();
  return steep;
}

std::vector<Model> models() {
  std::vector<Model> all = processes_and_measurements();
  for (const auto& more : {changes_of_variables(), starts()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

struct JacobianCase {
  Model model;
  Point point;
};

std::vector<JacobianCase> cases() {
  std::vector<JacobianCase> all;
  for (const Model& model : models()) {
    for (const Point& point : points()) all.push_back({model, point});
  }
  return all;
}

class JacobianTest : public ::testing::TestWithParam<JacobianCase> {};

TEST_P(JacobianTest, AgreesWithCentralDifferences) {
  const Model& model = GetParam().model;
  const Point& point = GetParam().point;
  const Matrix analytic = model.analytic(point);
  ASSERT_TRUE(analytic.allFinite());
  // Rows that hold sec(pitch) have third derivatives that grow as its fourth power; the others have not.
  const Vector steepness = Vector::Ones(analytic.rows()) +
                           0.01 * std::pow(trig(point).secant, 4) * steep_rows(model.name, analytic.rows());
  for (int column = 0; column < model.inputs; ++column) {
    Vector change = Vector::Zero(model.inputs);
    change(column) = kStep;
    const Vector numeric = (model.function(point, change) - model.function(point, -change)) / (2.0 * kStep);
    for (int row = 0; row < analytic.rows(); ++row) {
      const double size = 1.0 + analytic.row(row).cwiseAbs().maxCoeff();
      EXPECT_NEAR(numeric(row), analytic(row, column), kTolerance * size * steepness(row))
          << "row " << row << ", column " << column;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, JacobianTest, ::testing::ValuesIn(cases()), [](const auto& case_) {
  return case_.param.model.name + "_" + case_.param.point.name;
});

TEST(JacobianTest, TurnsTheErrorAsFarAsItsFirstOrderGoes) {
  const Vector3 direction = Vector3(0.6, -0.7, 0.4).normalized();
  for (const double angle : {0.0, 1.0e-4, 1.0e-3, 1.0e-2, 0.1}) {
    const Vector3 turn = angle * direction;
    const double next_term = angle * angle / 6.0;  // of the series of the derivative
    const Matrix3 analytic = error_after_turn(turn);
    for (int column = 0; column < 3; ++column) {
      const Vector3 step = kStep * Vector3::Unit(column);
      const auto error = [&](const Vector3& before) {
        return logarithm(exponential(-turn) * exponential(before));
      };
      const Vector3 numeric = (error(turn + step) - error(turn - step)) / (2.0 * kStep);
      EXPECT_LT((numeric - analytic.col(column)).norm(), kTolerance + next_term) << angle << ' ' << column;
    }
  }
}

TEST(JacobianTest, StaysFiniteAtThePole) {
  for (const double pitch : {kHalfPi, -kHalfPi}) {
    const Point pole{"Pole", {0.3, pitch, 1.0}, {1.0, 2.0, 3.0}, {0.3, 0.2, 0.1}, {0.0, 0.0, -9.8}};
    for (const Model& model : models()) EXPECT_TRUE(model.analytic(pole).allFinite()) << model.name;
  }
}

TEST(ExpectedFieldTest, PointsWhereTheStateExpectsIt) {
  const Vector3 theta(0.3, -0.2, 1.1);
  const EulerTrig at(theta);
  const Matrix3 R_NB = rotation_NB(at);
  const Vector3 m_B = R_NB.transpose() * kField;
  const double innovation = shortest_difference(ekf_mag(m_B, at, 0.6).y, theta.z());
  EXPECT_GT(std::abs(innovation), 0.1);
  const Vector3 expected_B = expected_field(m_B, R_NB.row(2).transpose(), innovation);
  constexpr double kRoundOff = 1.0e-12;
  EXPECT_NEAR(ekf_mag(expected_B, at, 0.6).y, theta.z(), kRoundOff);
  EXPECT_NEAR((R_NB * expected_B).z(), kField.z(), kRoundOff);
  EXPECT_NEAR(expected_B.norm(), 1.0, kRoundOff);
}

TEST(JacobianTest, StaysFiniteWhenTheFieldIsVertical) {
  const MagModel model = ekf_mag(Vector3::UnitZ(), EulerTrig(Vector3::Zero()), 0.0);
  EXPECT_TRUE(model.F.allFinite());
  EXPECT_TRUE(model.H().allFinite());
}

}  // namespace
}  // namespace ironbird::autopilot
