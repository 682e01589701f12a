#include "scenarios/fcu/parameter_bounds.hpp"

#include <bit>
#include <cmath>
#include <string_view>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"
#include "scenarios/config/shortest.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::kRealParameter;
using hil_bridge::ParameterRecord;
using hil_bridge::virtual_fcu::find_parameter;
using hil_bridge::virtual_fcu::kParameterCount;
using hil_bridge::virtual_fcu::kParameterTable;
using hil_bridge::virtual_fcu::ParameterId;
using hil_bridge::virtual_fcu::ParameterInfo;

/// A bound such as 0.0001 is met by the float nearest to it, which may be less.
bool within(const ParameterRecord& record, const ParameterInfo& info) {
  if (record.type == kRealParameter) {
    const auto value = std::bit_cast<float>(record.bits);
    return value >= static_cast<float>(info.lower) && value <= static_cast<float>(info.upper);
  }
  const auto value = static_cast<double>(std::bit_cast<std::int32_t>(record.bits));
  return value >= info.lower && value <= info.upper;
}

std::string shown(double bound, const ParameterInfo& info) {
  if (static_cast<std::uint8_t>(info.type) == kRealParameter) return shortest(bound);
  return std::to_string(static_cast<std::int64_t>(bound));
}

std::string unit_of(const ParameterInfo& info) {
  const std::string_view unit = info.unit;
  return unit.empty() || unit == "1" ? "" : " " + std::string(unit);
}

}  // namespace

std::string complaint_about_value(const ParameterRecord& record) {
  const ParameterId id = find_parameter(record.name);
  if (id.index == kParameterCount) return {};
  const ParameterInfo& info = kParameterTable[id.index];
  if (static_cast<std::uint8_t>(info.type) != record.type || record.bits == info.default_bits) return {};
  if (record.type == kRealParameter && !std::isfinite(std::bit_cast<float>(record.bits))) {
    return "must be finite";
  }
  if (within(record, info)) return {};
  return "must be between " + shown(info.lower, info) + " and " + shown(info.upper, info) + unit_of(info);
}

}  // namespace ironbird::scenarios
