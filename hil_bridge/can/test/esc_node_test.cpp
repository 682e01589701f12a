#include "hil_bridge/can/esc_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge::can {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint8_t kController = 10;
constexpr std::uint8_t kNode = 20;

/// A foreign controller that says exactly what a test wants, and keeps everything that it hears.
class EscNodeTest : public ::testing::Test {
 protected:
  EscNodeTest() { make({.node = kNode, .esc_index = 2}); }

  void make(const EscNodeParams& params) {
    params_ = params;
    node_.emplace(params, now_);
  }

  /// Lets time pass in steps of a millisecond.
  void run(Time duration) {
    for (const Time end = now_ + duration; now_ < end;) {
      controller_.flush(now_, controller_end_);
      node_->step(reading_, now_, node_end_);
      bus_.advance(now_ += milliseconds(1));
      while (const auto frame = node_end_.receive()) node_->take(*frame, now_);
      while (const auto frame = controller_end_.receive()) {
        if (const auto transfer = controller_.push(*frame)) hear(*transfer);
      }
    }
  }
  void hear(const ReceivedTransfer& transfer) {
    if (const auto status = message_of<NodeStatus>(transfer)) statuses_.push_back(*status);
    if (const auto report = message_of<EscStatus>(transfer)) reports_.push_back(*report);
    if (const auto info = message_of<GetNodeInfoResponse>(transfer)) info_ = *info;
    if (const auto value = message_of<GetSetResponse>(transfer)) value_ = *value;
    if (const auto done = message_of<ExecuteOpcodeResponse>(transfer)) done_ = *done;
    if (const auto again = message_of<RestartNodeResponse>(transfer)) restarted_ = *again;
  }

  void command(int raw) {
    RawCommand command;
    for (const int other : {111, 222, raw, 333}) command.cmd.push(static_cast<std::int16_t>(other));
    controller_.send(command, 7, now_);
    run(milliseconds(2));
  }
  void arm(std::uint8_t status = ArmingStatus::kArmed) {
    controller_.send(ArmingStatus{status}, 24, now_);
    run(milliseconds(2));
  }
  template <class M>
  void ask(const M& request) {
    controller_.send(request, 24, now_, kNode);
    run(milliseconds(20));
  }
  GetSetResponse get_set(std::string_view name, ParameterValue value = {}) {
    value_.reset();
    ask(GetSetRequest{0, value, ParameterName(name)});
    return value_.value();
  }
  double throttle() const { return node_->command(now_).throttle; }
  EscCondition condition() const { return node_->command(now_).condition; }

  static constexpr std::array kHears = {subscription<NodeStatus>(),
                                        subscription<EscStatus>(),
                                        subscription<GetNodeInfoResponse>(),
                                        subscription<GetSetResponse>(),
                                        subscription<ExecuteOpcodeResponse>(),
                                        subscription<RestartNodeResponse>()};
  static constexpr std::array kSays = {RawCommand::kType.key,           ArmingStatus::kType.key,
                                       GetNodeInfoRequest::kType.key,   GetSetRequest::kType.key,
                                       ExecuteOpcodeRequest::kType.key, RestartNodeRequest::kType.key};
  transport::InProcessBus bus_{{.fd = true}};
  transport::FrameBus& node_end_ = bus_.attach();
  transport::FrameBus& controller_end_ = bus_.attach();
  NodePort controller_{kController, kHears, kSays, false};
  EscNodeParams params_;
  std::optional<EscNode> node_;
  EscReading reading_;
  Time now_{0};
  std::vector<NodeStatus> statuses_;
  std::vector<EscStatus> reports_;
  std::optional<GetNodeInfoResponse> info_;
  std::optional<GetSetResponse> value_;
  std::optional<ExecuteOpcodeResponse> done_;
  std::optional<RestartNodeResponse> restarted_;
};

TEST_F(EscNodeTest, StandsStillBeforeAnythingIsSaid) {
  run(seconds(1));
  EXPECT_EQ(throttle(), 0.0);
  EXPECT_EQ(condition(), EscCondition::kNeverCommanded);
}

TEST_F(EscNodeTest, FollowsItsOwnPlaceInTheCommandOnceArmed) {
  arm();
  for (const int raw : {8191, 4096, 1, 0}) {
    command(raw);
    EXPECT_DOUBLE_EQ(throttle(), raw / 8191.0);
    EXPECT_EQ(condition(), EscCondition::kRunning);
  }
}

TEST_F(EscNodeTest, StopsAtANegativeCommand) {
  arm();
  command(-8192);
  EXPECT_EQ(throttle(), 0.0);
}

TEST_F(EscNodeTest, StandsStillUntilItHearsThatTheVehicleIsArmed) {
  command(4000);
  EXPECT_EQ(condition(), EscCondition::kDisarmed);
  for (const int status : {0, 1, 254}) {
    arm(static_cast<std::uint8_t>(status));
    EXPECT_EQ(throttle(), 0.0) << status;
  }
  arm(255);
  EXPECT_GT(throttle(), 0.0);
  arm(0);
  EXPECT_EQ(throttle(), 0.0);
}

TEST_F(EscNodeTest, StopsWhenItsCommandGrowsOld) {
  arm();
  command(4000);
  Time last_running = now_;
  const Time commanded = now_;
  while (condition() == EscCondition::kRunning && now_ < seconds(5)) {
    last_running = now_;
    run(milliseconds(1));
  }
  EXPECT_EQ(condition(), EscCondition::kStale);
  EXPECT_EQ(throttle(), 0.0);
  EXPECT_LE(last_running - commanded, milliseconds(100));
  EXPECT_GE(last_running - commanded, milliseconds(97)) << "the command was on its way for a while";
  command(4000);
  EXPECT_GT(throttle(), 0.0);
}

TEST_F(EscNodeTest, TakesACommandThatWaitedTooLongInAQueueForOld) {
  arm();
  RawCommand command{};
  for (int k = 0; k < 4; ++k) command.cmd.push(4000);
  controller_.send(command, 7, now_);
  controller_.flush(now_, controller_end_);
  bus_.advance(now_ += milliseconds(500));
  while (const auto frame = node_end_.receive()) node_->take(*frame, now_);
  EXPECT_EQ(condition(), EscCondition::kStale);
}

TEST_F(EscNodeTest, DoesNotTakeACommandForFreshForEverBecauseItsStampIsWrong) {
  arm();
  RawCommand command{};
  for (int k = 0; k < 4; ++k) command.cmd.push(4000);
  const Payload<RawCommand> payload = encode(command);
  FrameSplitter splitter({7, TransferKind::kMessage, RawCommand::kType.key.data_type_id, kController, 0, 9},
                         crc_seed(RawCommand::kType.signature), payload.view());
  node_->take({*splitter.next(), now_ + std::chrono::hours(1)}, now_);
  EXPECT_GT(throttle(), 0.0);
  run(milliseconds(101));
  EXPECT_EQ(condition(), EscCondition::kStale);
}

TEST_F(EscNodeTest, StopsWhenNobodySaysAnyMoreThatTheVehicleIsArmed) {
  arm();
  const Time armed = now_;
  while (now_ - armed < milliseconds(1970)) command(4000);
  EXPECT_EQ(condition(), EscCondition::kRunning);
  while (now_ - armed < milliseconds(2010)) command(4000);
  EXPECT_EQ(condition(), EscCondition::kDisarmed);
}

TEST_F(EscNodeTest, NeedsNoArmingWhenSetSoButObeysADisarming) {
  make({.node = kNode, .esc_index = 2, .require_arming = false});
  command(4000);
  EXPECT_GT(throttle(), 0.0);
  arm(0);
  EXPECT_EQ(throttle(), 0.0);
  run(seconds(5));
  command(4000);
  EXPECT_EQ(throttle(), 0.0) << "its last word counts";
}

TEST_F(EscNodeTest, IgnoresACommandThatDoesNotReachItsPlace) {
  arm();
  RawCommand two{};
  two.cmd.push(8000);
  two.cmd.push(8000);
  controller_.send(two, 7, now_);
  run(milliseconds(2));
  EXPECT_EQ(condition(), EscCondition::kNeverCommanded);
}

TEST_F(EscNodeTest, GivesASignOfLifeEverySecond) {
  reading_.health = kHealthWarning;
  run(seconds(10));
  ASSERT_EQ(statuses_.size(), 10U);
  for (std::size_t k = 0; k < statuses_.size(); ++k) EXPECT_EQ(statuses_[k].uptime_sec, k);
  EXPECT_EQ(statuses_[5].health, kHealthWarning);
  EXPECT_EQ(statuses_[5].mode, kModeOperational);
}

TEST_F(EscNodeTest, ReportsWhatTheRotorMeasures) {
  reading_ = {.speed = 523.6, .voltage = 22.25, .current = 12.5, .temperature = 320.0, .errors = 7};
  arm();
  command(4096);
  run(milliseconds(20));
  const EscStatus& report = reports_.back();
  EXPECT_EQ(report.rpm, 5000);
  EXPECT_EQ(report.voltage, 22.25F);
  EXPECT_EQ(report.current, 12.5F);
  EXPECT_EQ(report.temperature, 320.0F);
  EXPECT_EQ(report.error_count, 7U);
  EXPECT_EQ(report.power_rating_pct, 50);
  EXPECT_EQ(report.esc_index, 2);
}

TEST_F(EscNodeTest, ReportsAsOftenAsItIsSet) {
  for (const int rate : {10, 25, 50}) {
    make({.node = kNode, .status_rate = rate});
    reports_.clear();
    run(seconds(2));
    EXPECT_NEAR(static_cast<int>(reports_.size()), 2 * rate, 1) << rate;
  }
}

TEST_F(EscNodeTest, DoesNotMakeUpForReportsThatItMissed) {
  run(milliseconds(100));
  now_ += seconds(3);
  bus_.advance(now_);
  reports_.clear();
  run(milliseconds(100));
  EXPECT_LE(reports_.size(), 6U);
}

TEST_F(EscNodeTest, SendsNoNonsenseWhenTheReadingIsOne) {
  reading_.speed = NAN;
  reading_.voltage = INFINITY;
  run(milliseconds(30));
  EXPECT_EQ(reports_.back().rpm, 0);
  EXPECT_TRUE(std::isinf(reports_.back().voltage));
}

TEST_F(EscNodeTest, SaysWhoItIs) {
  run(milliseconds(3000));
  ask(GetNodeInfoRequest{});
  ASSERT_TRUE(info_.has_value());
  EXPECT_EQ(info_->name.text(), "org.ironbird.esc");
  EXPECT_EQ(info_->status.uptime_sec, 3U);
  EXPECT_EQ(info_->hardware_version.unique_id[15], 2);
}

TEST_F(EscNodeTest, ReportsInCanFdFramesAndAnswersTheWayItWasAsked) {
  make({.node = kNode, .esc_index = 2, .fd = true});
  reading_.speed = 523.6;
  run(milliseconds(100));
  EXPECT_EQ(reports_.back().rpm, 5000);
  ask(GetNodeInfoRequest{});
  EXPECT_TRUE(info_.has_value());
}

TEST_F(EscNodeTest, GivesItsParametersByIndexAndByName) {
  for (std::uint16_t index = 0; index < kEscParameters.size(); ++index) {
    value_.reset();
    ask(GetSetRequest{.index = index});
    ASSERT_TRUE(value_.has_value());
    EXPECT_EQ(value_->name.text(), kEscParameters[index].name);
    EXPECT_EQ(get_set(kEscParameters[index].name).value, value_->value);
  }
  EXPECT_EQ(get_set("ESC_INDEX").value, ParameterValue(std::int64_t{2}));
  EXPECT_EQ(get_set("REQUIRE_ARMING").value, ParameterValue(std::uint8_t{1}));
}

TEST_F(EscNodeTest, AnswersForAParameterThatItDoesNotHaveWithoutAName) {
  value_.reset();
  ask(GetSetRequest{.index = kEscParameters.size()});
  EXPECT_EQ(value_->name.count, 0U);
  EXPECT_EQ(get_set("NO_SUCH").name.count, 0U);
}

TEST_F(EscNodeTest, TakesAValueAndRefusesOneOutOfBoundsOrOfAnotherKind) {
  EXPECT_EQ(get_set("ESC_INDEX", std::int64_t{3}).value, ParameterValue(std::int64_t{3}));
  EXPECT_EQ(get_set("ESC_INDEX", std::int64_t{20}).value, ParameterValue(std::int64_t{3}));
  EXPECT_EQ(get_set("ESC_INDEX", std::int64_t{-1}).value, ParameterValue(std::int64_t{3}));
  EXPECT_EQ(get_set("ESC_INDEX", 1.0F).value, ParameterValue(std::int64_t{3}));
  EXPECT_EQ(get_set("ESC_INDEX", ParameterValue(BoundedText<128>("1"))).value,
            ParameterValue(std::int64_t{3}));
  arm();
  command(4000);
  EXPECT_DOUBLE_EQ(throttle(), 333 / 8191.0) << "its place in the command moved";
}

TEST_F(EscNodeTest, RemembersWhatWasSavedAcrossARestartAndNothingElse) {
  get_set("ESC_INDEX", std::int64_t{3});
  ask(ExecuteOpcodeRequest{ExecuteOpcodeRequest::kSave, 0});
  EXPECT_TRUE(done_->ok);
  get_set("ESC_INDEX", std::int64_t{5});
  ask(RestartNodeRequest{RestartNodeRequest::kMagicNumber});
  EXPECT_TRUE(restarted_->ok);
  EXPECT_EQ(get_set("ESC_INDEX").value, ParameterValue(std::int64_t{3}));
  ask(ExecuteOpcodeRequest{ExecuteOpcodeRequest::kErase, 0});
  EXPECT_EQ(get_set("ESC_INDEX").value, ParameterValue(std::int64_t{2}));
  ask(ExecuteOpcodeRequest{7, 0});
  EXPECT_FALSE(done_->ok);
}

TEST_F(EscNodeTest, StandsStillAfterARestartAndCountsItsUptimeAnew) {
  arm();
  run(seconds(3));
  arm();
  command(4000);
  ask(RestartNodeRequest{RestartNodeRequest::kMagicNumber});
  EXPECT_EQ(condition(), EscCondition::kNeverCommanded);
  command(4000);
  EXPECT_EQ(condition(), EscCondition::kDisarmed);
  run(milliseconds(1100));
  EXPECT_LE(statuses_.back().uptime_sec, 1U);
}

TEST_F(EscNodeTest, ForgetsInARestartWhatWasSaidOnArming) {
  make({.node = kNode, .esc_index = 2, .require_arming = false});
  arm(0);
  command(4000);
  EXPECT_EQ(condition(), EscCondition::kDisarmed);
  ask(RestartNodeRequest{RestartNodeRequest::kMagicNumber});
  command(4000);
  EXPECT_EQ(condition(), EscCondition::kRunning) << "it needs no word, and has heard none";
}

TEST_F(EscNodeTest, DoesNotRestartWithoutTheMagicNumber) {
  arm();
  command(4000);
  ask(RestartNodeRequest{0xACCE551B1F});
  EXPECT_FALSE(restarted_->ok);
  EXPECT_GT(throttle(), 0.0);
}

TEST_F(EscNodeTest, IsRefusedWithParametersOutOfBounds) {
  const auto reason = [](const EscNodeParams& params) -> std::string {
    try {
      EscNode node(params, Time(0));
      return "taken";
    } catch (const std::invalid_argument& problem) {
      return problem.what();
    }
  };
  EXPECT_EQ(reason({.node = 128}), "esc_node.node = 128, must be between 0 and 127");
  EXPECT_EQ(reason({.esc_index = 20}), "esc_node.esc_index = 20, must be between 0 and 19");
  EXPECT_EQ(reason({.status_rate = 100}), "esc_node.status_rate = 100 Hz, must be between 10 and 50");
  EXPECT_EQ(reason({.command_timeout = NAN}).substr(0, 25), "esc_node.command_timeout ");
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
