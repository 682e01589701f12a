#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// The firmware's parameters: a working copy and a saved one. Values are 32 bits each, either an int32 or a
/// float32; bits are compared, never converted, so that an integer whose bits are a NaN survives.
class ParameterStore {
 public:
  /// Told of every changed value, after it is stored.
  class Listener {
   public:
    virtual ~Listener() = default;
    virtual void parameter_changed(ParameterId id) = 0;
  };

  ParameterStore() { set_defaults(); }

  /// Who is told from now on; null for nobody. Not owned.
  void listen(Listener* listener) { listener_ = listener; }

  std::int32_t integer(ParameterId id) const { return std::bit_cast<std::int32_t>(values_[id.index]); }
  float real(ParameterId id) const { return std::bit_cast<float>(values_[id.index]); }
  std::uint32_t bits(ParameterId id) const { return values_[id.index]; }
  /// Is the integer parameter other than zero?
  bool on(ParameterId id) const { return values_[id.index] != 0; }

  /// Stores the value and tells the listener, unless the value is what it was. A NaN always counts as
  /// different. @return whether it was stored
  bool set_bits(ParameterId id, std::uint32_t bits);
  bool set(ParameterId id, std::int32_t value) { return set_bits(id, std::bit_cast<std::uint32_t>(value)); }
  bool set(ParameterId id, float value) { return set_bits(id, std::bit_cast<std::uint32_t>(value)); }

  /// Puts defaults into the working copy; tells nobody, as the firmware.
  void set_defaults();
  /// Copies the working copy to the saved one.
  void save() { saved_ = values_; }
  /// Copies the saved values to the working copy; tells nobody, as the firmware.
  void load() { values_ = saved_; }

 private:
  std::array<std::uint32_t, kParameterCount> values_{};
  std::array<std::uint32_t, kParameterCount> saved_{};
  Listener* listener_ = nullptr;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
