#include <nlohmann/json.hpp>

#include "scenarios/bench/run_time.hpp"
#include "scenarios/fcu/monitor_text.hpp"

namespace ironbird::scenarios {

namespace {

using namespace hil_bridge::rosflight;
using OrderedJson = nlohmann::ordered_json;

/// A message as its described members.
template <class M>
OrderedJson json_of(const M& message) {
  OrderedJson json;
  M::describe(message,
              [&](const char* name, const auto& member, const char*, const char*) { json[name] = member; });
  return json;
}

template <class M>
void add(OrderedJson& json, const char* name, const Monitored& unit) {
  if (const M* message = unit.view.latest<M>()) json[name] = json_of(*message);
}

OrderedJson link_of(const Monitored& unit) {
  const hil_bridge::LinkHealth health = unit.fcu.health(unit.now);
  const hil_bridge::TimeSyncState& time = unit.fcu.connection().time_sync();
  OrderedJson json;
  json["up"] = unit.line_up;
  json["silent"] = !silence_of(unit).empty();
  json["frames_per_second"] = health.frame_rate;
  json["bytes_per_second"] = health.byte_rate;
  json["loss"] = health.loss;
  json["lost"] = health.lost;
  json["corrupted"] = health.corrupted;
  if (health.age != hil_bridge::Time::max()) json["age_s"] = to_seconds(health.age);
  if (time.valid) json["round_trip_s"] = to_seconds(time.round_trip);
  return json;
}

}  // namespace

std::string monitor_json(const Monitored& unit) {
  OrderedJson json;
  json["time_s"] = to_seconds(unit.now - unit.since);
  json["link"] = link_of(unit);
  json["firmware"] = unit.fcu.connection().version();
  add<RosflightStatus>(json, "status", unit);
  add<AttitudeQuaternion>(json, "attitude", unit);
  add<SmallImu>(json, "imu", unit);
  add<SmallMag>(json, "mag", unit);
  add<SmallBaro>(json, "baro", unit);
  add<RosflightGnss>(json, "gnss", unit);
  add<DiffPressure>(json, "differential_pressure", unit);
  add<SmallRange>(json, "range", unit);
  add<RosflightOutputRaw>(json, "output_raw", unit);
  add<RosflightBatteryStatus>(json, "battery", unit);
  add<RcChannels>(json, "rc", unit);
  json["radio"] = unit.fcu.connection().radio_alive(unit.now);
  OrderedJson texts = OrderedJson::array();
  for (const UnitText& text : unit.view.texts()) {
    texts.push_back(
        {{"time_s", to_seconds(text.when - unit.since)}, {"severity", text.severity}, {"text", text.text}});
  }
  json["texts"] = texts;
  // A unit may send bytes that are no text.
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace ironbird::scenarios
