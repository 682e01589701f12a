// A run's log flown again: the same to the last bit, or the first difference by name.

#include "scenarios/replay/run_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/modules.hpp"
#include "scenarios/app/test/temporary_folder.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/bench/test/live_rig.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/cdr.hpp"
#include "scenarios/record/mcap_format.hpp"
#include "scenarios/requirements/metrics.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Settings = std::vector<std::pair<std::string, std::string>>;

std::string library(const std::string& name) {
  return std::string(IRONBIRD_SOURCE_DIR) + "/scenarios/library/" + name + ".toml";
}

class RunReplayTest : public ::testing::Test {
 protected:
  std::string log(const std::string& name = "flight") const { return (folder_ / (name + ".mcap")).string(); }

  /// Flies a scenario to its end, or for so long.
  void fly(const std::string& name, const Settings& settings = {}) const {
    const LoadedScenario loaded = load_scenario(library(name), {settings, std::nullopt}, modules_);
    BenchOptions options;
    options.log_file = log();
    Bench(loaded, modules_, options).fly();
  }

  /// Twelve seconds of the paper's mission as single records, of which a test may change some.
  void fly_a_journal() const {
    fly("paper/three_waypoints", {{"duration", "12"}, {"record.journal", "true"}});
  }

  ReplayResult replay(const Settings& settings = {}, const std::string& name = "flight",
                      const std::string& again = "") const {
    const RunLog flown = RunLog::read(log(name));
    const LoadedScenario loaded =
        load_flown(log(name), flown.configuration(), {settings, std::nullopt}, modules_);
    ReplayOptions options;
    if (!again.empty()) options.log_file = log(again);
    return RunReplay(flown, loaded, modules_, options).run();
  }

  std::string refusal(const std::string& name = "flight") const {
    try {
      replay({}, name);
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }

  std::string bytes(const std::string& name = "flight") const {
    std::ifstream stream(log(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(log(name), std::ios::binary) << content;
  }

  const TemporaryFolder folder_;
  const autopilot::Modules modules_ = autopilot::standard_modules();
};

/// Where a message lies in a journal.
struct Place {
  std::size_t record = 0;  ///< begins here
  std::size_t data = 0;
  std::size_t end = 0;
  double time = 0.0;
};

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// The messages of a topic, which lie in the journal one by one.
std::vector<Place> places_of(const std::string& topic, const std::string& file, const std::string& bytes) {
  const McapReader reader(file);
  std::vector<Place> places;
  for (std::size_t at = kMcapMagic.size(); at + kMcapRecordHead <= bytes.size();) {
    const std::size_t content = at + kMcapRecordHead;
    const std::size_t end = content + number_at<std::uint64_t>(bytes, at + 1);
    if (static_cast<McapOpcode>(bytes[at]) == McapOpcode::kMessage &&
        reader.channels().at(number_at<std::uint16_t>(bytes, content)).topic == topic) {
      places.push_back({at, content + 2 + 4 + 8 + 8, end,
                        static_cast<double>(number_at<std::uint64_t>(bytes, content + 6)) / 1e9});
    }
    at = end;
  }
  return places;
}

double figure(const ReplayResult& result, const std::string& name) {
  for (const Metric& metric : result.metrics) {
    if (metric.name == name) return metric.value;
  }
  ADD_FAILURE() << "no figure " << name;
  return 0.0;
}

void expect_same(const ReplayResult& result, const std::string& name) {
  ASSERT_TRUE(result.same) << name;
  EXPECT_EQ(result.same->outcome, Outcome::kPass) << name << ": " << result.same->explanation;
  EXPECT_THAT(result.same->explanation, AllOf(StartsWith("all "), EndsWith(" commands are the same")));
}

class FlownAgainTest : public RunReplayTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(FlownAgainTest, ComputesTheSameToTheLastBit) {
  fly(GetParam(), {{"duration", "45"}});
  expect_same(replay(), GetParam());
}

// Every kind of request, a swap in each kind of slot, gaps and noise in the frames, a line that loses some.
INSTANTIATE_TEST_SUITE_P(Scenarios, FlownAgainTest,
                         ::testing::Values("missions/operator", "missions/geodetic", "faults/estimator_swap",
                                           "faults/manager_swap", "faults/imu_gap", "faults/sensor_nan",
                                           "faults/link_loss", "entry_points/entry_08_torque_thrust"),
                         [](const auto& scenario) {
                           std::string name = scenario.param;
                           for (char& c : name) c = c == '/' ? '_' : c;
                           return name;
                         });

TEST_F(RunReplayTest, FliesARealUnitsFramesAgainThoughTheLoopStoodStill) {
  test::LiveRig rig;
  rig.options.log_file = log();
  ASSERT_TRUE(rig.flies_within(15.0));
  for (int k = 0; k < 5; ++k) {
    rig.there().stalled = std::chrono::milliseconds(15);  // then six frames come at once
    rig.until(0.5, [] { return false; });
  }
  rig.bench().stop();
  rig.bench().pass();
  rig.bench().finish(0.0);
  const ReplayResult result = replay();
  expect_same(result, "live");
  EXPECT_THAT(result.remarks, Not(Contains(HasSubstr("lacks")))) << "every frame of a pass is logged";
  EXPECT_LT(figure(result, "horizontal_difference_rms_m"), 1e-6) << "there is no truth: with itself";
}

TEST_F(RunReplayTest, WritesALogThatIsFlownAgainLikewise) {
  fly_a_journal();
  expect_same(replay({}, "flight", "again"), "first");
  expect_same(replay({}, "again"), "second");
  const std::string whole = bytes();
  const std::string again = bytes("again");
  const auto commands = [&](const std::string& of, const std::string& name) {
    std::string all;
    for (const Place& place : places_of("/autopilot/command", log(name), of))
      all += of.substr(place.data, place.end - place.data);
    return all;
  };
  EXPECT_EQ(commands(whole, "flight"), commands(again, "again"));
}

TEST_F(RunReplayTest, ComparesWithTruthWhereThereIsOne) {
  fly("paper/three_waypoints", {{"duration", "40"}});
  const ReplayResult result = replay();
  EXPECT_GT(figure(result, "horizontal_difference_rms_m"), 0.01);
  EXPECT_LT(figure(result, "horizontal_difference_rms_m"), 0.5);
  EXPECT_EQ(figure(result, "compared_share"), 1.0);
  EXPECT_NEAR(std::chrono::duration<double>(result.window.begin).count(), 8.4, 0.5) << "3 s after take-off";
}

TEST_F(RunReplayTest, TellsWhatAnotherConfigurationWouldHaveMadeOfIt) {
  fly_a_journal();
  const ReplayResult result = replay({{"autopilot.estimator.kind", "error_state"}});
  EXPECT_FALSE(result.same) << "it need not be";
  EXPECT_THAT(result.remarks,
              Contains(AllOf(StartsWith("the configuration is not the flight's; of what it computes some is "
                                        "different, the first at "),
                             HasSubstr(": /autopilot/estimate "))));
}

TEST_F(RunReplayTest, NamesTheFirstDifferenceWithTimeSignalAndBothValues) {
  fly_a_journal();
  std::string changed = bytes();
  const std::vector<Place> commands = places_of("/autopilot/command", log(), changed);
  const Place& place = commands.at(commands.size() / 2);
  // As if another one had been flown then.
  ByteBuffer other;
  encode_cdr(autopilot::FcuCommand(autopilot::PassThroughCommand{{0.25, 0.0, 0.0}, 0.5}), other);
  const std::string was = changed.substr(place.data, place.end - place.data);
  ASSERT_EQ(was.size(), other.size()) << "of the same kind";
  changed.replace(place.data, was.size(), reinterpret_cast<const char*>(other.data()), other.size());
  write("changed", changed);
  const ReplayResult result = replay({}, "changed");
  ASSERT_TRUE(result.same);
  EXPECT_EQ(result.same->outcome, Outcome::kFail);
  EXPECT_EQ(result.same->time, place.time);
  char where[60];
  std::snprintf(where, sizeof where, "the first at %.6f s: /autopilot/command ", place.time);
  EXPECT_THAT(result.same->explanation,
              AllOf(StartsWith("1 of " + std::to_string(commands.size()) + " commands are others"),
                    HasSubstr(where), HasSubstr("was 0.25, is ")));
}

TEST_F(RunReplayTest, NamesATextThatIsOther) {
  const Ros2Schema schema = ros2_schema<LoggedRequest>("request");
  Allowance allowance(schema.text.size());
  const auto types = parse_ros2_schema(schema.name, schema.text, allowance);
  const auto bytes_of_refusal = [](const std::string& reason) {
    ByteBuffer out;
    encode_cdr(logged(autopilot::TakeOff{}, {false, reason, {}}), out);
    return out;
  };
  const ByteBuffer was = bytes_of_refusal("it is not armed");
  const ByteBuffer is = bytes_of_refusal("it is not Armed");
  const FieldDifference difference = difference_of(types, was.bytes(), is.bytes());
  EXPECT_EQ(difference.field, "reason");
  EXPECT_EQ(difference.was, "\"it is not armed\"");
  EXPECT_EQ(difference.is, "\"it is not Armed\"");
  EXPECT_EQ(difference_of(types, was.bytes(), was.bytes()).field, "");
}

TEST_F(RunReplayTest, NamesTheEstimateWhenAFrameWasOther) {
  fly_a_journal();
  std::string changed = bytes();
  const std::vector<Place> frames = places_of("/autopilot/sensors", log(), changed);
  const Place& place = frames.at(frames.size() - 800);
  changed[place.data + 4 + 8 + 5] ^= 0x01;  // of the specific force, behind header and stamp
  write("changed", changed);
  const ReplayResult result = replay({}, "changed");
  ASSERT_TRUE(result.same);
  EXPECT_EQ(result.same->outcome, Outcome::kFail);
  EXPECT_GE(result.same->time, place.time);
  EXPECT_LE(result.same->time, place.time + 0.011) << "the estimate is logged every 10 ms";
  EXPECT_THAT(result.same->explanation, HasSubstr(": /autopilot/"));
}

TEST_F(RunReplayTest, SaysFromWhenOnFramesAreMissing) {
  fly_a_journal();
  std::string changed = bytes();
  const std::vector<Place> frames = places_of("/autopilot/sensors", log(), changed);
  const Place& place = frames.at(frames.size() - 800);
  changed.erase(place.record, place.end - place.record);
  write("changed", changed);
  const ReplayResult result = replay({}, "changed");
  ASSERT_TRUE(result.same);
  EXPECT_EQ(result.same->outcome, Outcome::kInconclusive);
  EXPECT_THAT(result.same->explanation, HasSubstr("then the log lacks 1 frames that flew"));
  EXPECT_THAT(result.remarks, Contains(StartsWith("the log lacks 1 frames, the first of them after ")));
}

TEST_F(RunReplayTest, FliesWhatIsLeftOfALogThatWasCut) {
  fly_a_journal();
  const std::string whole = bytes();
  for (const double share : {0.3, 0.77, 0.999}) {
    write("cut", whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    const ReplayResult result = replay({}, "cut");
    expect_same(result, "cut at " + std::to_string(share));
    EXPECT_THAT(result.remarks, Contains(StartsWith("the log was cut short at ")));
  }
}

TEST_F(RunReplayTest, RefusesALogWithoutFramesAndSaysHowToGetThem) {
  fly("paper/three_waypoints", {{"duration", "2"}, {"record.frames", "false"}});
  EXPECT_EQ(refusal(),
            log() +
                ": cannot be flown again: it has no /autopilot/sensors; fly the scenario again, with "
                "record.frames = true");
}

TEST_F(RunReplayTest, RefusesAnotherVersionsFrames) {
  fly("paper/three_waypoints", {{"duration", "2"}, {"record.journal", "true"}});
  std::string changed = bytes();
  int count = 0;  // the schema stands once in front and once in the summary
  for (std::size_t at = 0; (at = changed.find("specific force at the IMU", at)) != std::string::npos; ++count)
    changed[at] = 'S';
  ASSERT_GE(count, 1);
  write("changed", changed);
  EXPECT_THAT(
      refusal("changed"),
      AllOf(StartsWith(log("changed") + ": cannot be flown again: its /autopilot/sensors is of another "
                                        "version of Ironbird"),
            HasSubstr("scenario three_waypoints")));
}

TEST_F(RunReplayTest, NamesTheMessageThatIsDamaged) {
  fly_a_journal();
  std::string changed = bytes();
  const Place place = places_of("/autopilot/sensors", log(), changed).at(100);
  changed[place.data + 1] = 9;
  write("changed", changed);
  EXPECT_EQ(refusal("changed"),
            log("changed") + ": topic /autopilot/sensors, message 100: has another encoding than ours");
}

TEST_F(RunReplayTest, EndsInALineWhateverByteIsOther) {
  fly("paper/three_waypoints", {{"duration", "0.5"}, {"record.journal", "true"}});
  const std::string whole = bytes();
  for (std::size_t at = 8; at < whole.size(); at += whole.size() / 150 + 1) {
    std::string changed = whole;
    changed[at] = static_cast<char>(~changed[at]);
    write("changed", changed);
    try {
      replay({}, "changed");
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), StartsWith(log("changed"))) << at;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << at;
    }
  }
}

TEST_F(RunReplayTest, TakesTheConfigurationOfEveryScenarioBackFromItsLog) {
  namespace fs = std::filesystem;
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(IRONBIRD_SOURCE_DIR "/scenarios/library")) {
    if (entry.path().extension() != ".toml") continue;
    const LoadedScenario loaded = load_scenario(entry.path(), {}, modules_);
    const LoadedScenario again = load_flown("flight.mcap", loaded.effective_config, {}, modules_);
    EXPECT_EQ(again.digest, loaded.digest) << entry.path();
    EXPECT_EQ(again.scenario.waypoints.size(), loaded.scenario.waypoints.size()) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 40);
}

TEST_F(RunReplayTest, NamesAWrongSettingOfAFlownConfiguration) {
  fly("paper/three_waypoints", {{"duration", "2"}});
  const RunLog flown = RunLog::read(log());
  const auto finding = [&](const Settings& settings) {
    try {
      load_flown(log(), flown.configuration(), {settings, std::nullopt}, modules_);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(finding({{"autopilot.estimator.kind", "efk"}}), HasSubstr("did you mean"));
  EXPECT_THAT(finding({{"vehicle", "models/x650"}}), HasSubstr("the vehicle of a flight that was flown is"));
}

}  // namespace
}  // namespace ironbird::scenarios
