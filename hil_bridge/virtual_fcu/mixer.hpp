#pragma once

#include <array>
#include <cstdint>

#include "hil_bridge/rosflight/messages.hpp"
#include "hil_bridge/virtual_fcu/board.hpp"
#include "hil_bridge/virtual_fcu/canned_mixers.hpp"
#include "hil_bridge/virtual_fcu/motor_model.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"
#include "hil_bridge/virtual_fcu/text_log.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// What the mixer needs to know besides its ten inputs.
struct MixerConditions {
  bool armed = false;
  std::uint16_t overrides = 0;       ///< OverrideBit word: chooses primary or secondary mixer
  float density = kSeaLevelDensity;  ///< kg/m^3
  float battery_voltage = 0.0F;      ///< V, low-passed

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("armed", self.armed, "1", "motors may turn");
    visit("overrides", self.overrides, "1", "bits: which axes the pilot holds");
    visit("density", self.density, "kg/m^3", "of the air");
    visit("battery_voltage", self.battery_voltage, "V", "low-passed");
  }
};

/// Turns forces and torques into outputs. Primary mixer under the pilot's control, secondary under the
/// companion's. Scales motors down together when one exceeds its range: ratios survive, thrust and torques do
/// not, and no axis has priority.
class Mixer {
 public:
  /// Takes over the parameters that act at once: thresholds, motor model, output kinds, elements.
  void configure(const ParameterStore& parameters);
  /// Takes over one element of either mixer, or ignores the id.
  void set_element(const ParameterStore& parameters, ParameterId id);
  /// Chooses the mixers anew: at boot and when PRIMARY_MIXER, SECONDARY_MIXER, USE_MOTOR_PARAM or RC_F_AXIS
  /// changes. A canned mixer is written back into the parameters. Outputs become zero.
  /// @return whether the primary mixer exists; without it nothing is mixed
  bool rebuild(ParameterStore& parameters, TextLog& log);

  /// Stores the companion's auxiliary commands; a message with an illegal type is dropped whole.
  void take(const rosflight::RosflightAuxCmd& message);

  /// Computes all outputs. What is not a number makes no pulse: a motor stops, a servo stays where it is.
  /// @param u  forces x y z, torques x y z, four free inputs
  void mix(std::array<float, kMixerInputs> u, const MixerConditions& conditions, TextLog& log);

  bool valid() const { return valid_; }
  /// 0..1, always finite; pins of kind auxiliary hold their last value.
  const std::array<float, kOutputs>& outputs() const { return outputs_; }

 private:
  using Row = std::array<float, kMixerOutputs>;

  void choose_primary(int id, ParameterStore& parameters, TextLog& log);
  void choose_secondary(int id, ParameterStore& parameters, TextLog& log);
  void load_elements(const ParameterStore& parameters);
  Row sums(const std::array<float, kMixerInputs>& u, std::uint16_t overrides) const;
  void apply_motor_model(Row& row, const MixerConditions& conditions, TextLog& log) const;
  void scale_motors(Row& row, TextLog& log) const;
  void write(std::size_t pin, OutputKind kind, float value, bool armed);

  bool valid_ = false;
  MixerMatrix primary_{};
  MixerMatrix secondary_{};
  std::array<OutputKind, kMixerOutputs> kinds_{};
  std::array<float, kOutputs> auxiliary_{};
  std::array<OutputKind, kOutputs> auxiliary_kinds_{};
  std::array<float, kOutputs> outputs_{};

  bool use_motor_model_ = false;
  bool fixed_wing_ = false;
  bool spin_when_armed_ = true;
  float idle_ = 0.0F;
  std::size_t force_axis_ = 2;
  std::array<bool, 3> reversed_{};  // u3, u4, u5
  MotorModel motor_;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
