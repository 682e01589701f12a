#include "scenarios/fcu/wanted_parameters.hpp"

#include <bit>
#include <cmath>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::scenarios {

std::vector<hil_bridge::ParameterRecord> wanted_parameters(const Scenario& scenario) {
  using hil_bridge::virtual_fcu::kParameterTable;
  std::vector<hil_bridge::ParameterRecord> records;
  for (const auto& given : scenario.fcu.parameters) {
    const auto& info = kParameterTable[hil_bridge::virtual_fcu::find_parameter(given.name).index];
    const bool real = info.type == hil_bridge::virtual_fcu::ParameterType::kReal;
    records.push_back(
        {given.name, real ? hil_bridge::kRealParameter : hil_bridge::kIntegerParameter,
         real ? std::bit_cast<std::uint32_t>(static_cast<float>(given.value))
              : std::bit_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(given.value)))});
  }
  return records;
}

}  // namespace ironbird::scenarios
