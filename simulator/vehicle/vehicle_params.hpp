#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "simulator/types/linear_algebra.hpp"
#include "simulator/vehicle/battery.hpp"
#include "simulator/vehicle/rotor.hpp"

namespace ironbird::simulator {

/// Moments and products of inertia about the centre of mass, in B. The matrix has -Jxy, -Jxz, -Jyz off its
/// diagonal.
struct InertiaParams {
  double Jxx = 0.08;
  double Jyy = 0.08;
  double Jzz = 0.12;
  double Jxy = 0.0;
  double Jxz = 0.0;
  double Jyz = 0.0;

  Matrix3 matrix() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("Jxx", self.Jxx, "kg*m^2", "about Bx", 0.0, 1e4);
    visit("Jyy", self.Jyy, "kg*m^2", "about By", 0.0, 1e4);
    visit("Jzz", self.Jzz, "kg*m^2", "about Bz", 0.0, 1e4);
    visit("Jxy", self.Jxy, "kg*m^2", "integral of x y dm", -1e4, 1e4);
    visit("Jxz", self.Jxz, "kg*m^2", "integral of x z dm", -1e4, 1e4);
    visit("Jyz", self.Jyz, "kg*m^2", "integral of y z dm", -1e4, 1e4);
  }
};

/// Drag of everything but the rotors, and of the rotors' discs.
struct DragParams {
  double CD = 0.0;
  double area = 0.0;
  double induced = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("CD", self.CD, "1", "drag coefficient, the same in every direction", 0.0, 100.0);
    visit("area", self.area, "m^2", "reference area of CD", 0.0, 100.0);
    visit("induced", self.induced, "s/m", "horizontal force per thrust and airspeed", 0.0, 10.0);
  }
};

/// How the ground changes the thrust.
enum class GroundEffectKind : std::uint8_t {
  kNone,
  kThrustProportional,  ///< thrust over (1 - (R/4z)^2). Source: Cheeseman and Bennett, 1955
  kPolynomial           ///< a force that depends on the height only, as in the reference simulator
};

constexpr std::array<std::pair<GroundEffectKind, std::string_view>, 3> enumerators(GroundEffectKind) {
  return {{{GroundEffectKind::kNone, "none"},
           {GroundEffectKind::kThrustProportional, "thrust_proportional"},
           {GroundEffectKind::kPolynomial, "polynomial"}}};
}

struct GroundEffectParams {
  GroundEffectKind kind = GroundEffectKind::kNone;
  std::array<double, 5> polynomial = {0.0, 0.0, 0.0, 0.0, 0.0};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("kind", self.kind, "1", "none, thrust_proportional or polynomial");
    visit("polynomial", self.polynomial, "N, N/m, ..",
          "force along -Bz over the height, fourth power first; negative values count as zero", -1e5, 1e5);
  }
};

/// What touches the ground: spherical feet for standing, a box for lying on the side.
struct ContactParams {
  std::vector<Vector3> feet = {
      {0.15, 0.15, 0.2}, {-0.15, 0.15, 0.2}, {-0.15, -0.15, 0.2}, {0.15, -0.15, 0.2}};
  double foot_radius = 0.02;
  Vector3 body_half_size = {0.25, 0.25, 0.06};
  double friction = 0.8;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("feet", self.feet, "m", "centres of the feet from the centre of mass, in B", -10.0, 10.0);
    visit("foot_radius", self.foot_radius, "m", "of the feet", 1e-3, 1.0);
    visit("body_half_size", self.body_half_size, "m", "half the edges of the box around the rest", 0.0, 10.0);
    visit("friction", self.friction, "1", "coefficient of friction against everything", 0.0, 10.0);
  }
};

/// Everything that makes one multirotor different from another.
struct VehicleParams {
  std::string name = "multirotor";
  double mass = 3.5;
  InertiaParams inertia;
  std::vector<RotorMount> rotors;
  RotorParams rotor;
  DragParams drag;
  GroundEffectParams ground_effect;
  BatteryParams battery;
  ContactParams contact;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "1", "what it is called");
    visit("mass", self.mass, "kg", "ready to fly", 1e-3, 1e4);
    visit("inertia", self.inertia, "", "about the centre of mass");
    visit("rotors", self.rotors, "", "one entry per rotor; their order is that of the commands");
    visit("rotor", self.rotor, "", "propeller and motor, the same for every rotor");
    visit("drag", self.drag, "", "of the airframe");
    visit("ground_effect", self.ground_effect, "", "thrust near the ground");
    visit("battery", self.battery, "", "what feeds the motors");
    visit("contact", self.contact, "", "what touches the ground");
  }
};

/// @throws std::invalid_argument naming the first parameter that makes no sense, its value and its bound
void check(const VehicleParams& params);

/// The reference simulator's multirotor, to compare against it: quad X, rotors without inertia, 24 V always.
VehicleParams reference_multirotor();

}  // namespace ironbird::simulator
