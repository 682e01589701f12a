#include "scenarios/record/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "scenarios/record/log.hpp"
#include "scenarios/record/rewrite.hpp"
#include "scenarios/record/test/by_hand.hpp"
#include "scenarios/record/test/samples.hpp"

namespace ironbird::scenarios {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;

class RecorderTest : public ::testing::Test {
 protected:
  std::filesystem::path path(const std::string& suffix = "") const {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::path(::testing::TempDir()) /
           (std::string("recorder_") + test->name() + suffix + ".mcap");
  }

  samples::Inner inner_;
};

TEST_F(RecorderTest, WritesEachTopicAtTheMultiplesOfItsPeriod) {
  Recorder recorder(path());
  recorder.add("/fast", inner_);
  recorder.add("/slow", inner_, milliseconds(10));
  for (int i = 3; i < 35; ++i) recorder.observe(milliseconds(i));
  recorder.close();
  const Log log = Log::read(path());
  EXPECT_EQ(log.topic("/fast")->time().size(), 32u);
  EXPECT_THAT(log.topic("/slow")->time(), ElementsAre(0.003, 0.01, 0.02, 0.03));
}

TEST_F(RecorderTest, DoesNotDriftWhenItIsAskedBetweenTheMultiples) {
  Recorder recorder(path());
  recorder.add("/slow", inner_, milliseconds(10));
  for (int i = 0; i < 50; i += 3) recorder.observe(milliseconds(i));
  recorder.close();
  const Log log = Log::read(path());
  EXPECT_THAT(log.topic("/slow")->time(), ElementsAre(0.0, 0.012, 0.021, 0.03, 0.042));
}

TEST_F(RecorderTest, WritesWhenItIsToldAndNotOtherwise) {
  Recorder recorder(path());
  const Recorder::Channel channel = recorder.add("/told", inner_, {}, Recorder::When::kWhenTold);
  for (int i = 0; i < 10; ++i) {
    recorder.observe(milliseconds(i));
    if (i % 4 != 1) continue;
    recorder.write(channel, milliseconds(i));
    recorder.write(channel, milliseconds(i));
  }
  recorder.close();
  EXPECT_THAT(Log::read(path()).topic("/told")->time(),
              ElementsAre(0.001, 0.001, 0.005, 0.005, 0.009, 0.009));
}

TEST_F(RecorderTest, WritesNothingOfATopicThatARuleLeavesOut) {
  RecorderOptions options;
  options.topics = {{"/told", false, {}}};
  Recorder recorder(path(), options);
  recorder.write(recorder.add("/told", inner_, {}, Recorder::When::kWhenTold), milliseconds(1));
  recorder.close();
  EXPECT_EQ(Log::read(path()).topic("/told"), nullptr);
}

TEST_F(RecorderTest, HasATopicThatWasAnnouncedThoughNothingCameOfIt) {
  Recorder recorder(path());
  recorder.announce<samples::Inner>("/inner");
  recorder.announce<samples::Inner>("/silent");
  recorder.write_once("/inner", inner_, milliseconds(2));
  recorder.close();
  const Log log = Log::read(path());
  EXPECT_THAT(log.topic("/inner")->time(), ElementsAre(0.002));
  ASSERT_NE(log.topic("/silent"), nullptr);
  EXPECT_TRUE(log.topic("/silent")->time().empty());
}

TEST_F(RecorderTest, ShowsWhatTheStructHoldsAtThatMoment) {
  Recorder recorder(path());
  recorder.add("/inner", inner_);
  for (int i = 0; i < 3; ++i) {
    inner_.depth = 10.0 * i;
    inner_.wet = i == 1;
    recorder.observe(milliseconds(i));
  }
  recorder.close();
  const Log log = Log::read(path());
  EXPECT_THAT(log.topic("/inner")->column("depth"), ElementsAre(0.0, 10.0, 20.0));
  EXPECT_THAT(log.topic("/inner")->column("wet"), ElementsAre(0.0, 1.0, 0.0));
}

TEST_F(RecorderTest, ReadsBackEveryKindOfMember) {
  Recorder recorder(path());
  recorder.write_once("/everything", samples::filled(), milliseconds(1));
  recorder.close();
  const Log log = Log::read(path());
  const LogTopic& topic = *log.topic("/everything");
  const auto value = [&](const char* field) { return topic.column(field).at(0); };
  EXPECT_EQ(value("flag"), 1.0);
  EXPECT_EQ(value("whole"), -5.0);
  EXPECT_EQ(value("colour"), 7.0);
  EXPECT_EQ(value("stamp"), -1e-9);
  EXPECT_EQ(value("p_NB_N.z"), 3.0);
  EXPECT_EQ(value("plane.y"), 5.0);
  EXPECT_EQ(value("q_NB.w"), 0.5);
  EXPECT_EQ(value("inertia[5]"), 6.0);
  EXPECT_EQ(value("pair[1].depth"), 2.0);
  EXPECT_EQ(value("inners[0].depth"), 8.0);
  EXPECT_EQ(value("maybe"), 9.0);
  EXPECT_TRUE(std::isnan(value("perhaps.depth")));
  EXPECT_EQ(value("choice.inner.depth"), 12.0);
  EXPECT_EQ(topic.texts("label").at(0), "abc");
  EXPECT_EQ(topic.texts("note").at(0), "hi");
}

TEST_F(RecorderTest, FollowsTheLastRuleThatMatches) {
  RecorderOptions options;
  options.topics = {{.topic = "/truth/*", .record = false},
                    {.topic = "/truth/pose"},
                    {.topic = "/estimate", .period = milliseconds(20)}};
  Recorder recorder(path(), options);
  EXPECT_EQ(recorder.add("/truth/forces", inner_).index, -1);
  EXPECT_NE(recorder.add("/truth/pose", inner_).index, -1);
  recorder.add("/estimate", inner_);
  recorder.write_once("/truth/event", inner_, milliseconds(0));
  for (int i = 0; i < 40; ++i) recorder.observe(milliseconds(i));
  recorder.close();
  const Log log = Log::read(path());
  EXPECT_THAT(log.topics(), ElementsAre("/estimate", "/truth/pose"));
  EXPECT_EQ(log.topic("/truth/pose")->time().size(), 40u);
  EXPECT_THAT(log.topic("/estimate")->time(), ElementsAre(0.0, 0.02));
}

TEST_F(RecorderTest, WritesEventsWhenTheyHappen) {
  Recorder recorder(path());
  recorder.add("/live", inner_);
  recorder.observe(milliseconds(1));
  recorder.write_once("/event", samples::Inner{3.0, true}, milliseconds(2));
  recorder.write_once("/event", samples::Inner{4.0, true}, milliseconds(5));
  recorder.metadata("run", {{"seed", "7"}});
  recorder.close();
  const Log log = Log::read(path());
  EXPECT_THAT(log.topic("/event")->time(), ElementsAre(0.002, 0.005));
  EXPECT_THAT(log.topic("/event")->column("depth"), ElementsAre(3.0, 4.0));
  EXPECT_EQ(log.metadata().at("run").at("seed"), "7");
}

TEST_F(RecorderTest, WritesNumbersThatHaveNoStruct) {
  std::vector<double> values{1.0, 2.0};
  Recorder recorder(path());
  recorder.add_numbers("/autopilot/estimator/probe", {{"error", "rad", "of heading"}, {"gain", "1", ""}},
                       values.data(), milliseconds(2));
  for (int i = 0; i < 4; ++i, values[1] += 1.0) recorder.observe(milliseconds(i));
  EXPECT_THROW(recorder.add_numbers("/none", {}, values.data()), std::invalid_argument);
  recorder.close();
  const Log log = Log::read(path());
  const LogTopic& topic = *log.topic("/autopilot/estimator/probe");
  EXPECT_THAT(topic.column("error"), ElementsAre(1.0, 1.0));
  EXPECT_THAT(topic.column("gain"), ElementsAre(2.0, 4.0));
}

TEST_F(RecorderTest, RewritesAJournalAsTheSameLogInChunks) {
  const auto fly = [&](const std::filesystem::path& file, const McapOptions& options) {
    Recorder recorder(file, {.file = options, .topics = {}});
    recorder.add("/live", inner_);
    recorder.write_once("/event", samples::filled(), milliseconds(0));
    for (int i = 0; i < 3000; ++i) {
      inner_.depth = i;
      recorder.observe(milliseconds(i));
    }
    recorder.metadata("run", {{"seed", "7"}});
    recorder.close();
  };
  fly(path("_journal"), {.journal = true});
  fly(path("_chunks"), {});
  rewrite_log(path("_journal"), path("_rewritten"), {});
  const Log rewritten = Log::read(path("_rewritten"));
  const Log chunks = Log::read(path("_chunks"));
  EXPECT_EQ(rewritten.topics(), chunks.topics());
  EXPECT_EQ(rewritten.metadata(), chunks.metadata());
  EXPECT_EQ(rewritten.topic("/live")->time(), chunks.topic("/live")->time());
  EXPECT_EQ(rewritten.topic("/live")->column("depth"), chunks.topic("/live")->column("depth"));
  EXPECT_EQ(std::filesystem::file_size(path("_rewritten")), std::filesystem::file_size(path("_chunks")));
}

TEST_F(RecorderTest, RefusesATopicTwiceAndASecondType) {
  Recorder recorder(path());
  recorder.add("/live", inner_);
  EXPECT_THROW(recorder.add("/live", inner_), std::invalid_argument);
  recorder.write_once("/event", inner_, milliseconds(2));
  EXPECT_THROW(recorder.write_once("/event", samples::Nothing{}, milliseconds(2)), std::invalid_argument);
}

TEST_F(RecorderTest, GivesTheSameBytesForTheSameFlight) {
  for (const char* suffix : {"_1", "_2"}) {
    samples::Everything everything = samples::filled();
    Recorder recorder(path(suffix));
    recorder.add("/everything", everything, milliseconds(2));
    for (int i = 0; i < 1000; ++i) {
      everything.number = i;
      everything.inners.resize(static_cast<std::size_t>(i % 5));
      recorder.observe(milliseconds(i));
    }
    recorder.close();
  }
  const std::string first = by_hand::read_file(path("_1"));
  EXPECT_GT(first.size(), 100000u);
  EXPECT_EQ(first, by_hand::read_file(path("_2")));
}

TEST_F(RecorderTest, LeavesAReadableLogWhenNobodyClosesIt) {
  Recorder recorder(path(), {.file = {.chunk_size = 1024}, .topics = {}});
  recorder.add("/live", inner_);
  for (int i = 0; i < 200; ++i) recorder.observe(milliseconds(i));
  const Log log = Log::read(path());
  EXPECT_TRUE(log.truncated());
  EXPECT_GT(log.topic("/live")->time().size(), 150u);
}

TEST_F(RecorderTest, NamesAMissingFieldAndItsTopic) {
  Recorder recorder(path());
  recorder.write_once("/event", inner_, milliseconds(2));
  recorder.close();
  const Log log = Log::read(path());
  EXPECT_EQ(log.topic("/other"), nullptr);
  EXPECT_FALSE(log.topic("/event")->has("width"));
  try {
    log.topic("/event")->column("width");
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "topic /event has no field 'width'");
  }
  EXPECT_THROW(log.topic("/event")->texts("depth"), std::out_of_range);
}

}  // namespace
}  // namespace ironbird::scenarios
