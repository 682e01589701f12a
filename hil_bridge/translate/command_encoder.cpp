#include "hil_bridge/translate/command_encoder.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::hil_bridge {

namespace {

enum Mode : std::uint8_t { kPassThrough = 0, kRates = 1, kAngles = 2 };
enum Channel : std::size_t { kFz = 2, kQx = 3, kQy = 4, kQz = 5 };

rosflight::OffboardControl message(Mode mode, double fz, double qx, double qy, double qz) {
  rosflight::OffboardControl control;
  control.mode = mode;
  control.u[kFz] = static_cast<float>(fz);
  control.u[kQx] = static_cast<float>(qx);
  control.u[kQy] = static_cast<float>(qy);
  control.u[kQz] = static_cast<float>(qz);
  return control;
}

struct Encode {
  std::optional<rosflight::OffboardControl> operator()(const autopilot::SilenceCommand&) const {
    return std::nullopt;
  }
  std::optional<rosflight::OffboardControl> operator()(const autopilot::PassThroughCommand& c) const {
    return message(kPassThrough, -c.thrust, c.M_B.x(), c.M_B.y(), c.M_B.z());
  }
  std::optional<rosflight::OffboardControl> operator()(const autopilot::RateCommand& c) const {
    return message(kRates, c.throttle, c.w_NB_B.x(), c.w_NB_B.y(), c.w_NB_B.z());
  }
  std::optional<rosflight::OffboardControl> operator()(const autopilot::AngleCommand& c) const {
    return message(kAngles, c.throttle, c.roll, c.pitch, c.heading_rate);
  }
};

}  // namespace

std::optional<rosflight::OffboardControl> encode(const autopilot::FcuCommand& command) {
  const std::optional<rosflight::OffboardControl> control = std::visit(Encode{}, command);
  if (!control) return control;
  const bool finite =
      std::all_of(control->u.begin(), control->u.end(), [](float u) { return std::isfinite(u); });
  return finite ? control : std::nullopt;
}

}  // namespace ironbird::hil_bridge
