#pragma once

#include <array>
#include <span>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// A rotor as a mixer sees it.
struct MixerRotor {
  double x = 0.0;
  double y = 0.0;
  double torque_sign = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("x", self.x, "m", "from the centre of mass along Bx");
    visit("y", self.y, "m", "from the centre of mass along By");
    visit("torque_sign", self.torque_sign, "1", "+1 when its drag turns the vehicle about +Bz, else -1");
  }
};

/// A propeller as a mixer sees it.
struct MixerPropeller {
  double density = 1.225;
  double diameter = 0.381;
  double CT = 0.075;
  double CQ = 0.0045;

  double thrust_factor() const;  ///< k_T, N/(rad/s)^2
  double torque_factor() const;  ///< k_Q, N*m/(rad/s)^2

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("density", self.density, "kg/m^3", "of the air for which the mixer is made");
    visit("diameter", self.diameter, "m", "of the propeller");
    visit("CT", self.CT, "1", "thrust coefficient");
    visit("CQ", self.CQ, "1", "torque coefficient");
  }
};

/// Custom mixer in physical units: element [input][output] is the squared speed, (rad/s)^2, of that rotor per
/// newton or newton metre of that input (PRI_MIXER_input_output). Least-squares: the pseudo-inverse of what
/// squared speeds do to forces and torques. Inputs 2..5 are Fz, Qx, Qy, Qz; the other rows stay zero.
/// @param rotors  at most ten, in the order of the outputs
std::array<std::array<double, kMixerOutputs>, kMixerInputs> physical_mixer(std::span<const MixerRotor> rotors,
                                                                           const MixerPropeller& propeller);

}  // namespace ironbird::hil_bridge::virtual_fcu
