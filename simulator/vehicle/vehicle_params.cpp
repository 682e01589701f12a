#include "simulator/vehicle/vehicle_params.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "simulator/types/bounds.hpp"
#include "simulator/types/rotor_commands.hpp"

namespace ironbird::simulator {
namespace {

/// Room for rounding in a moment of inertia that is the sum of the others, as that of a flat plate is.
constexpr double kTriangleSlack = 1e-9;

/// Half of the thinnest body that an engine still takes for a body, m.
constexpr double kThinnest = 1e-3;

template <class Value>
[[noreturn]] void refuse(const std::string& name, const Value& value, const std::string& bound) {
  std::ostringstream text;
  text << "vehicle." << name << " = " << value << ", " << bound;
  throw std::invalid_argument(text.str());
}

void check_inertia(const Matrix3& J) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(J, Eigen::EigenvaluesOnly);
  const Vector3 principal = solver.eigenvalues();  // in increasing order
  if (principal.x() <= 0.0) {
    refuse("inertia", principal.x(), "its least principal moment, kg*m^2, must be > 0");
  }
  if (principal.z() > (principal.x() + principal.y()) * (1.0 + kTriangleSlack)) {
    refuse("inertia", principal.z(),
           "its greatest principal moment, kg*m^2, must not exceed the sum of the other two");
  }
}

void check_rotors(const VehicleParams& params) {
  const std::size_t count = params.rotors.size();
  if (count < 1 || count > kMaxRotors) {
    refuse("rotors", count, "their number must be between 1 and " + std::to_string(kMaxRotors));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (params.rotors[i].direction == 0) {
      refuse("rotors[" + std::to_string(i) + "].direction", 0, "must be 1 or -1");
    }
  }
  if (params.rotor.CT[0] <= 0.0) refuse("rotor.CT[0]", params.rotor.CT[0], "must be > 0");
  if (params.rotor.CQ[0] <= 0.0) refuse("rotor.CQ[0]", params.rotor.CQ[0], "must be > 0");
}

void check_contact(const ContactParams& contact) {
  if (contact.feet.size() < 3) refuse("contact.feet", contact.feet.size(), "must be at least 3 to stand");
  if (contact.body_half_size.minCoeff() < kThinnest) {
    refuse("contact.body_half_size", contact.body_half_size.minCoeff(), "m, must be >= 0.001");
  }
}

}  // namespace

Matrix3 InertiaParams::matrix() const {
  Matrix3 J;
  J << Jxx, -Jxy, -Jxz, -Jxy, Jyy, -Jyz, -Jxz, -Jyz, Jzz;
  return J;
}

void check(const VehicleParams& params) {
  check_bounds(params, "vehicle");
  check_inertia(params.inertia.matrix());
  check_rotors(params);
  check_contact(params.contact);
}

VehicleParams reference_multirotor() {
  VehicleParams params;
  params.name = "rosflight_multirotor";
  params.mass = 3.5;
  params.inertia = {.Jxx = 0.08, .Jyy = 0.08, .Jzz = 0.12};
  const double arm = 0.25 / std::sqrt(2.0);
  params.rotors = {
      {{arm, arm, 0.0}, -1}, {{-arm, arm, 0.0}, 1}, {{-arm, -arm, 0.0}, -1}, {{arm, -arm, 0.0}, 1}};
  params.drag = {.CD = 2.05, .area = 0.04, .induced = 0.05};
  params.ground_effect = {.kind = GroundEffectKind::kPolynomial,
                          .polynomial = {-55.3516, 181.8265, -203.9874, 85.3735, -7.6619}};
  params.battery.constant_voltage = 24.0;
  return params;
}

}  // namespace ironbird::simulator
