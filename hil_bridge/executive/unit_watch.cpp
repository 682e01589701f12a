#include "hil_bridge/executive/unit_watch.hpp"

#include <algorithm>
#include <bit>

namespace ironbird::hil_bridge {

bool override_mapped(const ParameterClient& parameters) {
  return switches_mapped([&](std::string_view name) {
    const auto record = parameters.find(name);
    return record ? std::bit_cast<std::int32_t>(record->bits) : -1;
  });
}

void report_presence(const Connection& connection, Time now, InterlockInputs& in) {
  in.link_alive = connection.heartbeat_alive(now);
  in.unit_armed = connection.armed(now);
  in.unit_disarmed = connection.disarmed(now);
  const auto& status = connection.status();
  in.unit_faultless = status && status->error_code == 0 && status->failsafe == 0;
  in.sensors_flow = connection.imu_alive(now);
  in.radio_present = connection.radio_alive(now);
}

void OwnUnitWatch::report(Time now, InterlockInputs& in) {
  report_presence(listener_, now, in);
  in.unit_known = true;
  in.parameters_equal = true;
  in.radio_present = in.radio_present && override_mapped_;
}

void LineUnitWatch::take(const Arrival& arrival) {
  news_ = news_ || std::holds_alternative<rosflight::ParamValue>(arrival.message);
}

void LineUnitWatch::report(Time now, InterlockInputs& in) {
  const Connection& connection = fcu_.connection();
  report_presence(connection, now, in);
  in.link_alive = in.link_alive && fcu_.line_is_up();
  in.unit_known = connection.state() == ConnectionState::kReady;
  if (!connection.parameters().progress().complete) {
    equal_ = false;
    news_ = true;
  } else if (news_) {
    compare();
  }
  in.parameters_equal = equal_;
  in.radio_present = in.radio_present && override_mapped_;
}

void LineUnitWatch::compare() {
  const ParameterClient& parameters = fcu_.connection().parameters();
  equal_ = std::all_of(wanted_.begin(), wanted_.end(),
                       [&](const ParameterRecord& wanted) { return parameters.find(wanted.name) == wanted; });
  override_mapped_ = override_mapped(parameters);
  news_ = false;
}

std::vector<ParameterDifference> LineUnitWatch::different() const {
  return not_as_wanted(wanted_, fcu_.connection().parameters().known());
}

}  // namespace ironbird::hil_bridge
