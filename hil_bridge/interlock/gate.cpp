#include "hil_bridge/interlock/gate.hpp"

#include <type_traits>

namespace ironbird::hil_bridge {

Effect effect_of(const rosflight::Message& message) {
  return std::visit(
      [](const auto& content) {
        using Content = std::decay_t<decltype(content)>;
        if constexpr (std::is_same_v<Content, rosflight::OffboardControl> ||
                      std::is_same_v<Content, rosflight::RosflightAuxCmd>) {
          return Effect::kMoves;
        } else if constexpr (std::is_same_v<Content, rosflight::ParamSet>) {
          return Effect::kChanges;
        } else if constexpr (std::is_same_v<Content, rosflight::RosflightCmd>) {
          return content.command == rosflight::kSendVersion ? Effect::kAsks : Effect::kChanges;
        } else if constexpr (std::is_same_v<Content, rosflight::ExternalAttitude>) {
          return Effect::kInforms;
        } else {
          return Effect::kAsks;
        }
      },
      message);
}

}  // namespace ironbird::hil_bridge
