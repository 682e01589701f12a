#include "scenarios/bench/autopilot_slots.hpp"

namespace ironbird::scenarios {

namespace {

template <class Base>
SlotAccess access(const autopilot::ModuleSlot<Base>& slot, autopilot::AutopilotConfig& config,
                  const autopilot::Modules& modules) {
  const autopilot::Registry<Base>& registry = modules.*slot.kinds;
  const char* name = slot.name;
  return {
      name, &(config.*slot.config), [&registry] { return registry.names(); },
      [&registry, name](const std::string& kind, autopilot::ParameterTable& table) -> std::shared_ptr<void> {
        std::shared_ptr<Base> module = registry.make(kind);
        if (module != nullptr) module->register_parameters(table, name);
        return module;
      }};
}

}  // namespace

std::vector<SlotAccess> all_slots(autopilot::AutopilotConfig& config, const autopilot::Modules& modules) {
  std::vector<SlotAccess> slots;
  autopilot::for_each_slot([&](const auto& slot) { slots.push_back(access(slot, config, modules)); });
  return slots;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace ironbird::scenarios
