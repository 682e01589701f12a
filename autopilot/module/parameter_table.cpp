#include "autopilot/module/parameter_table.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/module/module.hpp"

namespace ironbird::autopilot {

namespace {

bool is_below(std::string_view path, std::string_view prefix) {
  return path.size() > prefix.size() && path.substr(0, prefix.size()) == prefix && path[prefix.size()] == '.';
}

SetOutcome assign(bool& slot, const ParameterSlot&, const ParameterValue& value) {
  const bool* given = std::get_if<bool>(&value);
  if (given == nullptr) return SetOutcome::kWrongType;
  slot = *given;
  return SetOutcome::kAccepted;
}

SetOutcome assign(int& slot, const ParameterSlot& limits, const ParameterValue& value) {
  const int* given = std::get_if<int>(&value);
  if (given == nullptr) return SetOutcome::kWrongType;
  if (*given < limits.lower || *given > limits.upper) return SetOutcome::kOutOfBounds;
  slot = *given;
  return SetOutcome::kAccepted;
}

SetOutcome assign(double& slot, const ParameterSlot& limits, const ParameterValue& value) {
  double number = 0.0;
  if (const double* given = std::get_if<double>(&value)) {
    number = *given;
  } else if (const int* whole = std::get_if<int>(&value)) {
    number = *whole;
  } else {
    return SetOutcome::kWrongType;
  }
  if (!std::isfinite(number)) return SetOutcome::kNotFinite;
  if (number < limits.lower || number > limits.upper) return SetOutcome::kOutOfBounds;
  slot = number;
  return SetOutcome::kAccepted;
}

}  // namespace

void ParameterTable::remove(std::string_view prefix) {
  std::erase_if(slots_, [&](const ParameterSlot& slot) { return is_below(slot.path, prefix); });
}

const ParameterSlot* ParameterTable::find(std::string_view path) const {
  const auto found =
      std::find_if(slots_.begin(), slots_.end(), [&](const ParameterSlot& s) { return s.path == path; });
  return found == slots_.end() ? nullptr : &*found;
}

SetOutcome ParameterTable::set(std::string_view path, const ParameterValue& value) {
  const ParameterSlot* slot = find(path);
  if (slot == nullptr) return SetOutcome::kUnknown;
  const SetOutcome outcome =
      std::visit([&](auto* place) { return assign(*place, *slot, value); }, slot->value);
  if (outcome == SetOutcome::kAccepted && slot->owner != nullptr) slot->owner->parameters_changed();
  return outcome;
}

}  // namespace ironbird::autopilot
