#include "hil_bridge/virtual_fcu/parameter_store.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

bool ParameterStore::set_bits(ParameterId id, std::uint32_t bits) {
  const bool is_real = kParameterTable[id.index].type == ParameterType::kReal;
  const bool same = is_real ? std::bit_cast<float>(bits) == real(id) : bits == values_[id.index];
  if (same) return false;
  values_[id.index] = bits;
  if (listener_ != nullptr) listener_->parameter_changed(id);
  return true;
}

void ParameterStore::set_defaults() {
  for (int k = 0; k < kParameterCount; ++k) values_[k] = kParameterTable[k].default_bits;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
