// PX4 logs made by hand: which field of which version becomes which message, and what is said of what is
// missing.

#include "scenarios/replay/px4_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/test/log_by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using hil_bridge::Time;
using std::chrono::milliseconds;
using test::kBoot;
using test::LogByHand;
using test::UlogByHand;
using testing::Contains;
using testing::HasSubstr;
namespace rosflight = hil_bridge::rosflight;

template <class Content>
std::vector<std::pair<Time, Content>> of(const Px4Flight& px4) {
  std::vector<std::pair<Time, Content>> found;
  for (const hil_bridge::Arrival& arrival : px4.flight.messages) {
    if (const auto* content = std::get_if<Content>(&arrival.message))
      found.emplace_back(arrival.when, *content);
  }
  return found;
}

void add_old_fixes(UlogByHand& log) {
  log.format(
      "vehicle_gps_position:uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;int32_t lon;int32_t "
      "alt;float s_variance_m_s;float eph;float epv;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;uint8_t "
      "fix_type;bool vel_ned_valid;uint8_t satellites_used;");
  log.subscribe(0, 2, "vehicle_gps_position");
  for (std::uint64_t k = 0; k < 5; ++k)
    log.record(2, kBoot + 200'000 * k, std::uint64_t{1'685'000'000'000'000}, std::int32_t{473'000'000},
               std::int32_t{85'000'000}, std::int32_t{432'100}, 0.3F, 1.5F, 2.5F, 1.0F, -2.0F, 0.5F,
               std::uint8_t{4}, std::uint8_t{1}, std::uint8_t{14});
}

TEST(Px4FlightTest, MakesFramesOfTheImu) {
  const auto imu = of<rosflight::SmallImu>(LogByHand().second().read());
  ASSERT_EQ(imu.size(), 251U);
  EXPECT_EQ(imu[1].first, milliseconds(4));
  EXPECT_EQ(imu[1].second.time_boot_us, 4000U);
  EXPECT_EQ(imu[1].second.xgyro, 0.1F);
  EXPECT_EQ(imu[1].second.zgyro, 0.3F);
  EXPECT_EQ(imu[1].second.xacc, 0.5F);
  EXPECT_EQ(imu[1].second.zacc, -9.75F);
}

TEST(Px4FlightTest, PassesOverTimeThatRunsBackwardsAndMarksInvalidSamples) {
  LogByHand log;
  log.imu(0).imu(4000).imu(4000).imu(1000).imu(8000, 0x7fffffff).imu(12000);
  const Px4Flight px4 = log.read();
  const auto imu = of<rosflight::SmallImu>(px4);
  ASSERT_EQ(imu.size(), 4U);
  EXPECT_TRUE(std::isnan(imu[2].second.zacc));
  EXPECT_THAT(px4.flight.remarks,
              Contains(HasSubstr("2 samples of the IMU with stamps that the others do not share")));
  EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("1 samples of the IMU are not valid")));
}

TEST(Px4FlightTest, BridgesSamplesThatTheLogLacks) {
  LogByHand log;
  log.imu(0, 0, 0.0F).imu(12'000, 0, 0.3F).imu(212'000);  // two are missing, and then fifty: that is a gap
  const Px4Flight px4 = log.read();
  const auto imu = of<rosflight::SmallImu>(px4);
  ASSERT_EQ(imu.size(), 5U);
  EXPECT_EQ(imu[1].first, milliseconds(4));
  EXPECT_NEAR(imu[1].second.xgyro, 0.1, 1e-6);
  EXPECT_EQ(imu[2].first, milliseconds(8));
  EXPECT_NEAR(imu[2].second.xgyro, 0.2, 1e-6);
  EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("2 samples of the IMU that the log lacks")));
}

TEST(Px4FlightTest, ReadsFixesWithWholeLatitudesAndTheirAge) {
  LogByHand log;
  log.log().keyed('P', "float EKF2_GPS_DELAY", 150.0F);
  log.second();
  add_old_fixes(log.log());
  const Px4Flight px4 = log.read();
  const auto fixes = of<rosflight::RosflightGnss>(px4);
  ASSERT_EQ(fixes.size(), 4U) << "the first was measured before the first sample of the IMU";
  EXPECT_EQ(fixes[1].first, milliseconds(400));
  EXPECT_EQ(fixes[1].second.rosflight_timestamp, 250'000U) << "measured before it arrived";
  EXPECT_DOUBLE_EQ(fixes[1].second.lat, 47.3);
  EXPECT_DOUBLE_EQ(fixes[1].second.lon, 8.5);
  EXPECT_FLOAT_EQ(fixes[1].second.height, 432.1F);
  EXPECT_EQ(fixes[1].second.vel_e, -2.0F);
  EXPECT_EQ(fixes[1].second.h_acc, 1.5F);
  EXPECT_EQ(fixes[1].second.s_acc, 0.3F);
  EXPECT_EQ(fixes[1].second.num_sat, 14);
  EXPECT_EQ(fixes[1].second.fix_type, 3) << "differential is one in three dimensions";
  EXPECT_DOUBLE_EQ(px4.gnss_delay, static_cast<double>(150.0F) * 1e-3);
  EXPECT_DOUBLE_EQ(log.read({.mag = {}, .gnss_delay = 0.05}).gnss_delay, 0.05);
  EXPECT_DOUBLE_EQ(*px4.unix_time, 1.685e9);
}

TEST(Px4FlightTest, ReadsFixesInDegrees) {
  LogByHand log;
  log.second();
  log.log().format(
      "sensor_gps:uint64_t timestamp;double latitude_deg;double longitude_deg;double altitude_msl_m;uint8_t "
      "fix_type;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;");
  log.log()
      .subscribe(0, 2, "sensor_gps")
      .record(2, kBoot + 200'000, 33.5, -117.5, 46.9, std::uint8_t{6}, 0.0F, 0.0F, 0.0F);
  const auto fixes = of<rosflight::RosflightGnss>(log.read());
  ASSERT_EQ(fixes.size(), 1U);
  EXPECT_DOUBLE_EQ(fixes[0].second.lat, 33.5);
  EXPECT_DOUBLE_EQ(fixes[0].second.lon, -117.5);
  EXPECT_FLOAT_EQ(fixes[0].second.height, 46.9F);
  EXPECT_EQ(fixes[0].second.fix_type, 7) << "RTK fixed";
  EXPECT_EQ(fixes[0].second.rosflight_timestamp, 90'000U) << "PX4's usual delay";
}

TEST(Px4FlightTest, ReadsEveryLayoutOfTheBarometer) {
  const auto first_of = [](const char* format, const char* topic, auto... values) {
    LogByHand log;
    log.second();
    log.log().format(format).subscribe(0, 3, topic).record(3, kBoot + 20'000, values...);
    return of<rosflight::SmallBaro>(log.read()).at(0).second;
  };
  const auto old = first_of(
      "vehicle_air_data:uint64_t timestamp;float baro_alt_meter;float baro_temp_celcius;float "
      "baro_pressure_pa;",
      "vehicle_air_data", 100.0F, 25.0F, 101'000.0F);
  EXPECT_EQ(old.pressure, 101'000.0F);
  EXPECT_FLOAT_EQ(old.temperature, 298.15F);
  const auto newer = first_of(
      "vehicle_air_data:uint64_t timestamp;float baro_alt_meter;float baro_pressure_pa;float "
      "ambient_temperature;",
      "vehicle_air_data", 100.0F, 95'000.0F, 30.0F);
  EXPECT_EQ(newer.pressure, 95'000.0F);
  EXPECT_FLOAT_EQ(newer.temperature, 303.15F);
  EXPECT_EQ(first_of("sensor_baro:uint64_t timestamp;float pressure;float temperature;", "sensor_baro",
                     1013.25F, 20.0F)
                .pressure,
            101'325.0F)
      << "hectopascal";
  EXPECT_NEAR(
      first_of("vehicle_air_data:uint64_t timestamp;float baro_alt_meter;", "vehicle_air_data", 1000.0F)
          .pressure,
      89'875.0, 5.0)
      << "a height alone";
}

/// Magnetometers with these strengths, gauss, in the order of their instances.
Px4Flight with_mags(const std::vector<float>& strengths, const Px4Choice& choice = {}) {
  LogByHand log;
  log.second();
  add_old_fixes(log.log());
  log.log().format("vehicle_magnetometer:uint64_t timestamp;float[3] magnetometer_ga;");
  for (std::size_t k = 0; k < strengths.size(); ++k) {
    const auto id = static_cast<std::uint16_t>(10 + k);
    log.log().subscribe(static_cast<std::uint8_t>(k), id, "vehicle_magnetometer");
    for (std::uint64_t i = 0; i < 2; ++i)
      log.log().record(id, kBoot + 500'000 * i, 0.1F * strengths[k], 0.0F, std::sqrt(0.99F) * strengths[k]);
  }
  return log.read(choice);
}

TEST(Px4FlightTest, TakesTheMagnetometerThatFitsTheEarthsField) {
  const Px4Flight px4 = with_mags({0.65F, 0.48F, 0.30F});  // 0.48 G in Zurich
  EXPECT_EQ(px4.mag, 1);
  ASSERT_EQ(px4.mags.size(), 3U);
  EXPECT_LT(px4.mags[1].misfit, 0.03);
  EXPECT_NEAR(px4.mags[0].misfit, 0.35, 0.03);
  const auto samples = of<rosflight::SmallMag>(px4);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_NEAR(samples[0].second.xmag, 0.048, 1e-6);
}

TEST(Px4FlightTest, TakesTheMagnetometerThatIsNamedOrSaysWhichThereAre) {
  EXPECT_EQ(with_mags({0.65F, 0.48F}, {.mag = 0, .gnss_delay = {}}).mag, 0);
  try {
    with_mags({0.65F, 0.48F}, {.mag = 4, .gnss_delay = {}});
    FAIL();
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(), "by_hand.ulg: has no magnetometer 4; there are: 0, 1");
  }
}

TEST(Px4FlightTest, RefusesAMagnetometerThatIsNamedAndTellsNothing) {
  EXPECT_EQ(with_mags({0.0F, 0.48F}).mag, 1);
  EXPECT_EQ(with_mags({0.0F, 0.48F}).mag_source, "the only one of the log");
  try {
    with_mags({0.0F, 0.48F}, {.mag = 0, .gnss_delay = {}});
    FAIL();
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(), "by_hand.ulg: magnetometer 0 tells no field in any sample; there are: 1");
  }
}

TEST(Px4FlightTest, PassesOverAMagnetometerThatWasAnnouncedAndNeverCame) {
  LogByHand log;
  log.second();
  log.log().format("vehicle_magnetometer:uint64_t timestamp;float[3] magnetometer_ga;");
  log.log().subscribe(0, 10, "vehicle_magnetometer").subscribe(1, 11, "vehicle_magnetometer");
  log.log().record(10, kBoot, 0.2F, 0.0F, 0.4F);
  EXPECT_EQ(log.read().mags.size(), 1U);
  EXPECT_THROW(log.read({.mag = 1, .gnss_delay = {}}), UserError);
}

TEST(Px4FlightTest, KnowsWhenItWasAirborneAndArmed) {
  LogByHand log;
  log.second();
  log.log()
      .format("vehicle_land_detected:uint64_t timestamp;bool landed;")
      .subscribe(0, 30, "vehicle_land_detected");
  log.log()
      .record(30, kBoot - 900'000, std::uint8_t{1})
      .record(30, kBoot + 300'000, std::uint8_t{0})
      .record(30, kBoot + 700'000, std::uint8_t{1});
  log.log()
      .format(
          "vehicle_status:uint64_t timestamp;uint8_t arming_state;uint8_t hil_state;uint8_t vehicle_type;")
      .subscribe(0, 31, "vehicle_status");
  log.log()
      .record(31, kBoot - 900'000, std::uint8_t{1}, std::uint8_t{0}, std::uint8_t{1})
      .record(31, kBoot + 250'000, std::uint8_t{2}, std::uint8_t{0}, std::uint8_t{1});
  const Px4Flight px4 = log.read();
  ASSERT_EQ(px4.flight.airborne.size(), 1U);
  EXPECT_EQ(px4.flight.airborne[0].begin, milliseconds(300));
  EXPECT_EQ(px4.flight.airborne[0].end, milliseconds(700));
  for (const auto& [when, status] : of<rosflight::RosflightStatus>(px4))
    EXPECT_EQ(status.armed != 0, when >= milliseconds(300));
  EXPECT_FALSE(px4.simulated);
}

TEST(Px4FlightTest, SaysWhatIsMissingOrIsNoFlight) {
  LogByHand log;
  log.log().keyed('I', "char[9] ver_hw", "PX4_SITL_").keyed('I', "char[3] sys_name", "PX4");
  log.second();
  log.log()
      .format("vehicle_status:uint64_t timestamp;uint8_t vehicle_type;")
      .subscribe(0, 31, "vehicle_status")
      .record(31, kBoot, std::uint8_t{2});
  const Px4Flight px4 = log.read();
  EXPECT_TRUE(px4.simulated);
  for (const char* said : {"the log of a simulation", "the log of a fixed wing", "no GNSS fixes",
                           "no magnetometer", "no barometer", "no estimate of PX4's"})
    EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr(said)));
  UlogByHand empty;
  EXPECT_THROW(read_px4_flight(empty.read(), "empty.ulg"), UserError);
}

TEST(Px4FlightTest, SetsAsideAStampThatTheOthersDoNotShare) {
  for (const std::uint64_t wild : {std::uint64_t{0}, std::uint64_t{30}}) {
    LogByHand log;
    for (std::uint64_t k = 0; k < 100; ++k) log.imu(k == wild ? 3'600'000'000 : 4000 * k);
    const Px4Flight px4 = log.read();
    EXPECT_LE(px4.flight.end, milliseconds(400));
    EXPECT_GE(of<rosflight::SmallImu>(px4).size(), 99U)
        << "with one put in its place, but where it was the first";
    EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("1 samples of the IMU with stamps that the others")));
  }
}

TEST(Px4FlightTest, EndsWhereTheClockStepsBackForGood) {
  LogByHand log;
  for (std::uint64_t k = 0; k < 100; ++k) log.imu(5'000'000 + 4000 * k);
  for (std::uint64_t k = 0; k < 100; ++k) log.imu(4000 * k);
  const Px4Flight px4 = log.read();
  EXPECT_EQ(of<rosflight::SmallImu>(px4).size(), 100U);
  EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("its clock steps back by 5.4 s after 0.4 s")));
}

TEST(Px4FlightTest, TakesNoDelayThatCannotBeAndNoFixThatIsNone) {
  for (const float delay : {std::nanf(""), 1e30F, -5000.0F}) {
    LogByHand log;
    log.log().keyed('P', "float EKF2_GPS_DELAY", delay);
    log.second();
    add_old_fixes(log.log());
    const Px4Flight px4 = log.read();
    EXPECT_DOUBLE_EQ(px4.gnss_delay, 0.11);
    EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("EKF2_GPS_DELAY")));
  }
  LogByHand log;
  log.second().topic(2,
                     "sensor_gps:uint64_t timestamp;double latitude_deg;double longitude_deg;double "
                     "altitude_msl_m;uint8_t fix_type;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;");
  for (const double latitude : {std::nan(""), 33.5}) {
    log.log().record(2, kBoot + 500'000, latitude, -117.5, 46.9, std::uint8_t{3}, 0.0F, 0.0F, 0.0F);
  }
  const Px4Flight px4 = log.read();
  ASSERT_TRUE(px4.first_fix);
  EXPECT_EQ(px4.first_fix->lat, 33.5);
  EXPECT_GT(px4.first_fix->h_acc, 0.0F) << "a receiver that does not tell its accuracy has a usual one";
  EXPECT_THAT(px4.flight.remarks, Contains(HasSubstr("1 of its GNSS fixes are no numbers")));
}

TEST(Px4FlightTest, MakesNoMoreOfAGapOfDaysThanOfOneOfSeconds) {
  LogByHand log;
  log.imu(0).imu(4000).imu(900'000'000'000);
  EXPECT_LT(log.read().flight.messages.size(), 10U);
}

TEST(Px4FlightTest, PutsTheImuBehindWhatCameAtTheSameTime) {
  LogByHand log;
  log.second();
  add_old_fixes(log.log());
  const Px4Flight px4 = log.read();
  Time last{};
  bool imu_before = false;
  for (const hil_bridge::Arrival& arrival : px4.flight.messages) {
    EXPECT_GE(arrival.when, last);
    EXPECT_FALSE(arrival.when == last && last > Time::zero() && imu_before);
    imu_before = std::holds_alternative<rosflight::SmallImu>(arrival.message);
    last = arrival.when;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
