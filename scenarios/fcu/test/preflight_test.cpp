#include "scenarios/fcu/preflight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <map>
#include <string>

#include "hil_bridge/transport/stream_pair.hpp"
#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::scenarios {
namespace {

using namespace hil_bridge::rosflight;
using hil_bridge::ParameterRecord;
using hil_bridge::Time;
using hil_bridge::virtual_fcu::kParameterTable;
using testing::HasSubstr;

/// A unit that says what it is told to say, at the rates of a board.
struct Unit {
  Heartbeat heartbeat{.mavlink_version = kDialectVersion};
  RosflightStatus status;
  SmallImu imu{.zacc = -9.80665F};
  AttitudeQuaternion attitude{.q1 = 1.0F};
  RosflightGnss fix{.fix_type = 3, .num_sat = 12};
  RosflightBatteryStatus battery{.battery_voltage = 24.0F};
  RcChannels rc;
  std::map<std::string, double> parameters = {{"FAILSAFE_THR", 0.3}};
  std::string version = "v2.0.1";
  int imu_period = 1;  // in ticks of 2.5 ms; 0: never
  int rc_period = 4;
  int gnss_period = 40;
  int mag_period = 4;
  int baro_period = 8;
  int heartbeat_period = 400;
  bool answers_clock = true;
  int loses = 0;  // every so many frames one
};

class Desk {
 public:
  explicit Desk(const Unit& unit) : unit_(unit), fcu_(pair_.near()) {
    unit_.rc.chan_raw.fill(1500);
    unit_.rc.chan_raw[2] = 1000;
  }

  /// Four seconds of the unit's life, watched.
  std::vector<PreflightItem> look(const PreflightWishes& wishes, std::uint16_t throttle = 1000) {
    unit_.rc.chan_raw[2] = throttle;
    for (int k = 1; k <= 1600; ++k) tick(k);
    return preflight({fcu_, view_, "here", true, now_, Time{}}, wishes);
  }

 private:
  void say(const Message& message) {
    const FrameBytes frame = encode_frame(message, sequence_++, {1, 250});
    if (unit_.loses != 0 && ++said_ % unit_.loses == 0) return;
    pair_.far().write(std::span(frame.bytes).first(frame.size));
  }
  void say_every(int period, int tick, const Message& message) {
    if (period != 0 && tick % period == 0) say(message);
  }
  void answer() {
    std::array<std::uint8_t, 4096> bytes{};
    const std::size_t count = pair_.far().read(bytes);
    decoder_.push(std::span(bytes).first(count), [&](const Frame& frame) {
      if (std::holds_alternative<ParamRequestList>(frame.message)) list_ = true;
      if (const auto* clock = std::get_if<Timesync>(&frame.message); clock != nullptr && unit_.answers_clock)
        say(Timesync{now_.count() + 1, clock->ts1});
      const auto* order = std::get_if<RosflightCmd>(&frame.message);
      if (order != nullptr && order->command == kSendVersion && unit_.status.armed == 0)
        say(RosflightVersion{field_of<50>(unit_.version)});
      if (const auto* read = std::get_if<ParamRequestRead>(&frame.message);
          read != nullptr && read->param_index >= 0)
        say(parameter(static_cast<std::size_t>(read->param_index)));
    });
    if (list_)
      for (std::size_t k = 0; k < kParameterTable.size(); ++k) say(parameter(k));
    list_ = false;
  }
  ParamValue parameter(std::size_t k) const {
    const auto& info = kParameterTable[k];
    const bool real = info.type == hil_bridge::virtual_fcu::ParameterType::kReal;
    ParamValue value{.param_count = kParameterTable.size(),
                     .param_index = static_cast<std::uint16_t>(k),
                     .param_id = field_of<16>(text_of(info.name)),
                     .param_type = static_cast<std::uint8_t>(real ? 9 : 6)};
    value.param_value.bits = info.default_bits;
    const auto given = unit_.parameters.find(std::string(text_of(info.name)));
    if (given != unit_.parameters.end()) {
      value.param_value.bits = real ? std::bit_cast<std::uint32_t>(static_cast<float>(given->second))
                                    : std::bit_cast<std::uint32_t>(static_cast<std::int32_t>(given->second));
    }
    return value;
  }
  void tick(int k) {
    now_ = k * std::chrono::microseconds(2500);
    answer();
    unit_.imu.time_boot_us = static_cast<std::uint64_t>(k) * 2500;
    say_every(unit_.imu_period, k, unit_.imu);
    say_every(unit_.imu_period, k, unit_.attitude);
    say_every(unit_.mag_period, k, SmallMag{0.2F, 0.0F, 0.4F});
    say_every(unit_.baro_period, k, SmallBaro{1387.0F, 85'700.0F, 290.0F});
    say_every(unit_.gnss_period, k, unit_.fix);
    say_every(unit_.rc_period, k, unit_.rc);
    say_every(40, k, unit_.status);
    say_every(40, k, unit_.battery);
    say_every(unit_.heartbeat_period, k, unit_.heartbeat);
    fcu_.advance(now_);
    heard_.clear();
    fcu_.receive(heard_);
    for (const hil_bridge::Arrival& arrival : heard_) view_.take(arrival);
  }

  Unit unit_;
  hil_bridge::transport::StreamPair pair_;
  hil_bridge::SerialFcu fcu_;
  UnitView view_;
  StreamDecoder decoder_;
  std::vector<hil_bridge::Arrival> heard_;
  Time now_{};
  std::uint8_t sequence_ = 0;
  int said_ = 0;
  bool list_ = false;
};

PreflightWishes wishes() {
  PreflightWishes wishes;
  wishes.scenario = "mission.toml";
  wishes.parameters = {ParameterRecord{"FAILSAFE_THR", 9, std::bit_cast<std::uint32_t>(0.3F)},
                       ParameterRecord{"RC_NUM_CHN", 6, 6}};
  return wishes;
}

std::vector<std::string> red(const std::vector<PreflightItem>& items) {
  std::vector<std::string> names;
  for (const PreflightItem& item : items) {
    if (item.light == Light::kRed) names.push_back(item.name);
  }
  return names;
}

TEST(PreflightTest, IsGreenForAUnitAsItShouldBe) {
  const auto items = Desk(Unit{}).look(wishes());
  EXPECT_THAT(red(items), testing::IsEmpty()) << preflight_text(items, false);
  EXPECT_TRUE(all_green(items));
}

struct Flaw {
  const char* name;
  void (*make)(Unit&);
  std::vector<std::string> red;
  const char* reason;
};

class PreflightFlawTest : public testing::TestWithParam<Flaw> {};

TEST_P(PreflightFlawTest, TurnsItsOwnLightRedAndSaysWhy) {
  Unit unit;
  GetParam().make(unit);
  const auto items = Desk(unit).look(wishes());
  EXPECT_EQ(red(items), GetParam().red) << preflight_text(items, false);
  EXPECT_THAT(preflight_text(items, false), HasSubstr(GetParam().reason));
  EXPECT_FALSE(all_green(items));
}

INSTANTIATE_TEST_SUITE_P(
    Each, PreflightFlawTest,
    testing::Values(
        Flaw{"NoHeartbeat",
             [](Unit& unit) { unit.heartbeat_period = 0; },
             {"link", "version"},
             "heartbeat younger than 3 s"},
        Flaw{"Losses", [](Unit& unit) { unit.loses = 20; }, {"loss"}, "at most 1 % may be lost"},
        Flaw{"NoClock", [](Unit& unit) { unit.answers_clock = false; }, {"time"}, "0 exchanges"},
        Flaw{
            "OtherDialect", [](Unit& unit) { unit.heartbeat.mavlink_version = 3; }, {"version"}, "dialect 3"},
        Flaw{"OtherParameter",
             [](Unit& unit) { unit.parameters["FAILSAFE_THR"] = 0.4; },
             {"parameters"},
             "1 of 2 are not the scenario's: FAILSAFE_THR is 0.4, wanted 0.3; push them: ironbird fcu params "
             "load mission.toml"},
        Flaw{"SlowImu", [](Unit& unit) { unit.imu_period = 2; }, {"IMU"}, "samples/s of 400"},
        Flaw{"Uncalibrated",
             [](Unit& unit) { unit.status.error_code = kUncalibratedImu; },
             {"calibration", "faults"},
             "ironbird fcu calibrate imu"},
        Flaw{"Tilting", [](Unit& unit) { unit.imu.xgyro = 0.2F; }, {"calibration"}, "does it stand still"},
        Flaw{"NoCompass", [](Unit& unit) { unit.mag_period = 0; }, {"compass"}, "0 samples/s, needs 40"},
        Flaw{"NoBarometer", [](Unit& unit) { unit.baro_period = 0; }, {"barometer"}, "0 samples/s, needs 40"},
        Flaw{"NoFix", [](Unit& unit) { unit.fix.fix_type = 2; }, {"satellites"}, "fixes/s of kind 2"},
        Flaw{"NoRadio",
             [](Unit& unit) { unit.rc_period = 0; },
             {"radio", "throttle"},
             "switch the transmitter on"},
        Flaw{"NoOverride",
             [](Unit& unit) { unit.parameters["RC_ATT_OVRD_CHN"] = -1; },
             {"radio"},
             "map RC_ATT_OVRD_CHN"},
        Flaw{"FilterThatFailed",
             [](Unit& unit) { unit.attitude.q3 = std::numeric_limits<float>::quiet_NaN(); },
             {"attitude"},
             "reboot the unit, or calibrate its IMU"},
        Flaw{"FirstOfItsVersion",
             [](Unit& unit) { unit.version = "v2.0.0"; },
             {"version"},
             "flash a firmware of version 2.0.1 or later"},
        Flaw{"Armed",
             [](Unit& unit) { unit.status.armed = 1; },
             {"version", "disarmed"},
             "ARMED: disarm it by radio"},
        Flaw{"Failsafe", [](Unit& unit) { unit.status.failsafe = 1; }, {"faults"}, "failsafe flag"},
        Flaw{"EmptyBattery",
             [](Unit& unit) { unit.battery.battery_voltage = 20.0F; },
             {"battery"},
             "20.00 V of 25.00 V"},
        Flaw{"LongTimeout",
             [](Unit& unit) { unit.parameters["OFFBOARD_TIMEOUT"] = 1000; },
             {"failsafe"},
             "OFFBOARD_TIMEOUT 1000 ms"}),
    [](const testing::TestParamInfo<Flaw>& flaw) { return flaw.param.name; });

TEST(PreflightTest, WantsTheThrottleDown) {
  const auto items = Desk(Unit{}).look(wishes(), 1300);
  EXPECT_EQ(red(items), std::vector<std::string>{"throttle"});
  EXPECT_THAT(preflight_text(items, false), HasSubstr("at 30 %, must be below 15 %"));
}

TEST(PreflightTest, ComparesNoParametersWithoutAScenario) {
  const auto items = Desk(Unit{}).look({});
  EXPECT_TRUE(all_green(items));
  EXPECT_THAT(preflight_text(items, false), HasSubstr("-   parameters   not compared"));
}

TEST(PreflightTest, UsesTheWordsOfTheInterlock) {
  const std::string text = preflight_text(Desk(Unit{}).look(wishes()), false);
  const hil_bridge::InterlockInputs in;
  hil_bridge::InterlockInputs::describe(
      in, [&](const std::string& name, bool, const char*, const char* meaning) {
        const bool shown = name == "link_alive" || name == "unit_disarmed" || name == "unit_faultless";
        if (shown) {
          EXPECT_THAT(text, HasSubstr(meaning));
        }
      });
}

}  // namespace
}  // namespace ironbird::scenarios
