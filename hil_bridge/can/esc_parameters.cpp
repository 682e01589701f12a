#include "hil_bridge/can/esc_parameters.hpp"

#include <algorithm>
#include <optional>

namespace ironbird::hil_bridge::can {

namespace {

std::size_t place_of(const GetSetRequest& request) {
  if (request.name.count == 0) return request.index;
  const auto found =
      std::find_if(kEscParameters.begin(), kEscParameters.end(),
                   [&](const EscParameterInfo& info) { return info.name == request.name.text(); });
  return static_cast<std::size_t>(found - kEscParameters.begin());
}

/// The value that a request wants to set, if it is of the kind that the parameter has.
std::optional<std::int64_t> wanted(const ParameterValue& value, const EscParameterInfo& info) {
  if (const auto* truth = std::get_if<std::uint8_t>(&value); truth != nullptr && info.truth) return *truth;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return *number;
  return std::nullopt;
}

ParameterValue value_of(std::int64_t number, const EscParameterInfo& info) {
  if (info.truth) return static_cast<std::uint8_t>(number);
  return number;
}

}  // namespace

GetSetResponse EscParameters::get_set(const GetSetRequest& request) {
  const std::size_t place = place_of(request);
  if (place >= kEscParameters.size()) return {};
  const EscParameterInfo& info = kEscParameters[place];
  const std::optional<std::int64_t> value = wanted(request.value, info);
  if (value && *value >= info.least && *value <= info.greatest) values_[place] = *value;
  GetSetResponse response;
  response.value = value_of(values_[place], info);
  response.default_value = value_of(defaults_[place], info);
  if (!info.truth) {
    response.min_value = info.least;
    response.max_value = info.greatest;
  }
  response.name = ParameterName(info.name);
  return response;
}

ExecuteOpcodeResponse EscParameters::execute(const ExecuteOpcodeRequest& request) {
  if (request.opcode == ExecuteOpcodeRequest::kSave) {
    saved_ = values_;
  } else if (request.opcode == ExecuteOpcodeRequest::kErase) {
    saved_ = defaults_;
    values_ = defaults_;
  } else {
    return {.ok = false};
  }
  return {.ok = true};
}

}  // namespace ironbird::hil_bridge::can
