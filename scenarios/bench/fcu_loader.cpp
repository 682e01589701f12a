#include "scenarios/bench/fcu_loader.hpp"

#include <bit>
#include <cmath>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"
#include "scenarios/config/include.hpp"
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/config/toml_reader.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::rosflight::text_of;
using hil_bridge::virtual_fcu::kParameterTable;
using hil_bridge::virtual_fcu::ParameterInfo;
using hil_bridge::virtual_fcu::ParameterType;

constexpr const char* kPath = "fcu.parameters";

const ParameterInfo* find(std::string_view name) {
  for (const ParameterInfo& info : kParameterTable) {
    if (text_of(info.name) == name) return &info;
  }
  return nullptr;
}

std::string unknown(const std::string& name) {
  std::vector<std::string> names;
  for (const ParameterInfo& info : kParameterTable) names.emplace_back(text_of(info.name));
  const std::string nearest = nearest_name(name, names);
  return std::string(kPath) + "." + name + ": the firmware has no such parameter" +
         (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
}

double default_of(const ParameterInfo& info) {
  return info.type == ParameterType::kReal
             ? static_cast<double>(std::bit_cast<float>(info.default_bits))
             : static_cast<double>(std::bit_cast<std::int32_t>(info.default_bits));
}

double read(const toml::node& node, const ParameterInfo& info, const std::string& path,
            std::vector<std::string>& findings) {
  const double usual = default_of(info);
  if (node.is_number() && *node.value<double>() == usual) return usual;
  TomlReader reader;
  const Allowed allowed{info.unit, info.lower, info.upper};
  double value = usual;
  if (info.type == ParameterType::kReal) {
    reader.read_value(node, value, allowed, path);
  } else {
    std::int32_t whole = 0;
    reader.read_value(node, whole, allowed, path);
    value = whole;
  }
  findings.insert(findings.end(), reader.findings().begin(), reader.findings().end());
  return value;
}

}  // namespace

void take_fcu_parameters(toml::table& root, hil_bridge::VirtualFcuConfig& config,
                         std::vector<std::string>& findings) {
  toml::table* fcu = root["fcu"].as_table();
  const toml::node* node = fcu == nullptr ? nullptr : fcu->get("parameters");
  if (node == nullptr) return;
  if (const toml::table* parameters = node->as_table()) {
    for (const auto& [key, value] : *parameters) {
      const std::string name(key.str());
      if (const ParameterInfo* info = find(name)) {
        config.parameters.push_back({name, read(value, *info, std::string(kPath) + "." + name, findings)});
      } else {
        const std::string place = location(key.source());
        findings.push_back((place.empty() ? place_of(value) : place) + ": " + unknown(name));
      }
    }
  } else {
    findings.push_back(place_of(*node) + ": " + kPath +
                       ": must be a table of names and values, written [fcu.parameters]");
  }
  fcu->erase("parameters");
}

}  // namespace ironbird::scenarios
