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

ParameterValue value_of(const ParameterSlot& slot) {
  return std::visit([](const auto* place) { return ParameterValue(*place); }, slot.value);
}

SetOutcome put(const ParameterSlot& slot, const ParameterValue& value) {
  return std::visit([&](auto* place) { return assign(*place, slot, value); }, slot.value);
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

std::optional<ParameterValue> ParameterTable::get(std::string_view path) const {
  const ParameterSlot* slot = find(path);
  if (slot == nullptr) return std::nullopt;
  return value_of(*slot);
}

SetOutcome ParameterTable::set(std::string_view path, const ParameterValue& value, bool in_flight,
                               std::string* reason) {
  const ParameterSlot* slot = find(path);
  if (slot == nullptr) return SetOutcome::kUnknown;
  const ParameterValue before = value_of(*slot);
  const SetOutcome outcome = put(*slot, value);
  if (outcome != SetOutcome::kAccepted || slot->owner == nullptr) return outcome;
  const auto refuse = [&](SetOutcome refusal, std::string_view why) {
    put(*slot, before);
    if (reason != nullptr) *reason = why;
    return refusal;
  };
  Module& owner = *slot->owner;
  if (const std::string_view why = owner.parameter_conflict(); !why.empty())
    return refuse(SetOutcome::kConflict, why);
  if (!in_flight) {
    owner.parameters_configured();
    return outcome;
  }
  if (const std::string_view why = owner.parameter_danger(); !why.empty())
    return refuse(SetOutcome::kNotInFlight, why);
  owner.parameters_changed();
  return outcome;
}

std::string ParameterTable::set_all(const std::vector<ParameterSetting>& settings) {
  std::string conflict;
  for (const auto& [path, value] : settings) {
    if (const ParameterSlot* slot = find(path)) put(*slot, value);
  }
  Module* told = nullptr;
  for (const auto& [path, value] : settings) {
    const ParameterSlot* slot = find(path);
    if (slot == nullptr || slot->owner == nullptr || slot->owner == told) continue;
    told = slot->owner;
    const std::string_view reason = told->parameter_conflict();
    if (!reason.empty() && conflict.empty())
      conflict = path.substr(0, path.find('.')) + "." + std::string(reason);
    told->parameters_configured();
  }
  return conflict;
}

}  // namespace ironbird::autopilot
