#include "hil_bridge/can/dynamic_node_id.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "hil_bridge/can/esc_controller.hpp"
#include "hil_bridge/can/esc_node.hpp"
#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge::can {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;

UniqueId unique(std::uint8_t first) {
  UniqueId id{};
  for (std::size_t k = 0; k < id.size(); ++k) id[k] = static_cast<std::uint8_t>(first + k);
  return id;
}

Allocation message(std::uint8_t node, bool first, const UniqueId& id, std::size_t from, std::size_t to) {
  Allocation allocation = {node, first, {}};
  for (std::size_t k = from; k < to; ++k) allocation.unique_id.push(id[k]);
  return allocation;
}

const auto kNobody = [](std::uint8_t) { return false; };

TEST(NodeIdServerTest, GrantsAsRecorded) {
  // The conversation of the recorded transfers: three parts, their echoes, the grant of 125.
  const UniqueId id = unique(0xA0);
  NodeIdServer server;
  EXPECT_EQ(server.take(message(0, true, id, 0, 6), seconds(1), kNobody)->unique_id,
            message(0, false, id, 0, 6).unique_id);
  EXPECT_EQ(server.take(message(0, false, id, 6, 12), seconds(1), kNobody)->unique_id,
            message(0, false, id, 0, 12).unique_id);
  const std::optional<Allocation> grant = server.take(message(0, false, id, 12, 16), seconds(1), kNobody);
  EXPECT_EQ(grant->node_id, 125);
  EXPECT_FALSE(grant->first_part_of_unique_id);
  EXPECT_EQ(grant->unique_id, message(0, false, id, 0, 16).unique_id);
}

std::uint8_t granted(NodeIdServer& server, const UniqueId& id, std::uint8_t wish,
                     const std::function<bool(std::uint8_t)>& taken = kNobody) {
  server.take(message(wish, true, id, 0, 6), Time(0), taken);
  server.take(message(0, false, id, 6, 12), Time(0), taken);
  const std::optional<Allocation> grant = server.take(message(0, false, id, 12, 16), Time(0), taken);
  return grant ? grant->node_id : 0;
}

TEST(NodeIdServerTest, GrantsUpwardsFromTheWishThenDownwards) {
  NodeIdServer server;
  EXPECT_EQ(granted(server, unique(1), 50), 50);
  EXPECT_EQ(granted(server, unique(2), 50), 51);
  EXPECT_EQ(granted(server, unique(3), 0), 125);
  EXPECT_EQ(granted(server, unique(4), 0), 124);
  EXPECT_EQ(granted(server, unique(5), 125), 123);
  EXPECT_EQ(granted(server, unique(6), 127), 122) << "numbers of tools are not given away";
}

TEST(NodeIdServerTest, GrantsTheSameNumberToTheSameNodeAgain) {
  NodeIdServer server;
  EXPECT_EQ(granted(server, unique(1), 50), 50);
  EXPECT_EQ(granted(server, unique(2), 50), 51);
  EXPECT_EQ(granted(server, unique(1), 77), 50);
}

TEST(NodeIdServerTest, GrantsNoNumberThatIsInUse) {
  NodeIdServer server;
  EXPECT_EQ(granted(server, unique(1), 20, [](std::uint8_t node) { return node < 30; }), 30);
  EXPECT_EQ(granted(server, unique(2), 20, [](std::uint8_t) { return true; }), 0) << "the bus is full";
}

TEST(NodeIdServerTest, ForgetsAPartWhenTheNextDoesNotFollow) {
  const UniqueId id = unique(0xA0);
  NodeIdServer server;
  server.take(message(0, true, id, 0, 6), seconds(1), kNobody);
  EXPECT_FALSE(server.take(message(0, false, id, 6, 12), milliseconds(1501), kNobody));
  server.take(message(0, true, id, 0, 6), seconds(2), kNobody);
  EXPECT_TRUE(server.take(message(0, false, id, 6, 12), milliseconds(2500), kNobody));
}

TEST(NodeIdServerTest, IgnoresPartsThatDoNotFit) {
  const UniqueId id = unique(0xA0);
  NodeIdServer server;
  EXPECT_FALSE(server.take(message(0, false, id, 6, 12), seconds(1), kNobody)) << "not the first";
  EXPECT_FALSE(server.take(message(0, true, id, 0, 5), seconds(1), kNobody));
  server.take(message(0, true, id, 0, 6), seconds(1), kNobody);
  EXPECT_FALSE(server.take(message(0, false, id, 6, 10), seconds(1), kNobody));
}

TEST(NodeIdServerTest, TakesAllOfItAtOnceAsCanFdSendsIt) {
  NodeIdServer server;
  EXPECT_EQ(server.take(message(33, true, unique(7), 0, 16), seconds(1), kNobody)->node_id, 33);
}

class NodeIdClientTest : public ::testing::Test {
 protected:
  /// Lets time pass until something is sent.
  Allocation next() {
    const Time end = now_ + seconds(2);
    while (now_ < end) {
      if (const auto sent = client_.step(now_ += milliseconds(1))) return *sent;
    }
    ADD_FAILURE() << "nothing was sent";
    return {};
  }

  UniqueId id_ = unique(0xA0);
  Time now_{0};
  NodeIdClient client_{id_, 42, Time(0)};
};

TEST_F(NodeIdClientTest, WaitsBeforeItAsksAndBetweenItsAttempts) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    const Time before = now_;
    const Allocation sent = next();
    EXPECT_GE(now_ - before, milliseconds(600));
    EXPECT_LE(now_ - before, milliseconds(1001));
    EXPECT_TRUE(sent.first_part_of_unique_id);
    EXPECT_EQ(sent.node_id, 42);
    EXPECT_EQ(sent.unique_id, message(0, true, id_, 0, 6).unique_id);
  }
}

TEST_F(NodeIdClientTest, GoesOnAfterEachAnswerAndTakesTheGrant) {
  next();
  client_.take(message(0, false, id_, 0, 6), false, now_);
  Time before = now_;
  EXPECT_EQ(next().unique_id, message(0, false, id_, 6, 12).unique_id);
  EXPECT_LE(now_ - before, milliseconds(401));
  client_.take(message(0, false, id_, 0, 12), false, now_);
  const Allocation last = next();
  EXPECT_EQ(last.unique_id, message(0, false, id_, 12, 16).unique_id);
  EXPECT_FALSE(last.first_part_of_unique_id);
  client_.take(message(77, false, id_, 0, 16), false, now_);
  EXPECT_EQ(client_.node(), 77);
  EXPECT_FALSE(client_.step(now_ + seconds(10)));
}

TEST_F(NodeIdClientTest, BeginsAgainWhenSomebodyElseSpeaks) {
  next();
  client_.take(message(0, false, id_, 0, 6), false, now_);
  client_.take(message(0, true, unique(0x10), 0, 6), true, now_);
  const Time before = now_;
  EXPECT_TRUE(next().first_part_of_unique_id);
  EXPECT_GE(now_ - before, milliseconds(600));
}

TEST_F(NodeIdClientTest, TakesNoGrantForAnotherOrFromNobody) {
  next();
  UniqueId other = id_;
  other[15] ^= 1U;
  client_.take(message(77, false, other, 0, 16), false, now_);
  EXPECT_FALSE(client_.node());
  client_.take(message(77, false, id_, 0, 16), true, now_);
  EXPECT_FALSE(client_.node());
}

/// Four ESCs without numbers, and the bench that gives them out.
class AllocationOnABusTest : public ::testing::Test {
 protected:
  AllocationOnABusTest() {
    for (int motor = 0; motor < 4; ++motor) {
      escs_.emplace_back(EscNodeParams{.node = 0, .esc_index = motor}, Time(0));
      ends_.push_back(&bus_.attach());
    }
  }
  void run(Time duration) {
    for (const Time end = now_ + duration; now_ < end;) {
      controller_.command(std::array{0.1, 0.2, 0.3, 0.4}, now_);
      controller_.step(now_);
      for (std::size_t k = 0; k < 4; ++k) escs_[k].step({}, now_, *ends_[k]);
      bus_.advance(now_ += milliseconds(2));
      for (std::size_t k = 0; k < 4; ++k) {
        while (const auto frame = ends_[k]->receive()) escs_[k].take(*frame, now_);
      }
    }
  }
  std::vector<int> numbers() const {
    std::vector<int> all;
    for (const EscNode& esc : escs_) all.push_back(esc.port().node());
    return all;
  }

  transport::InProcessBus bus_;
  transport::FrameBus& end_ = bus_.attach();
  EscController controller_{{.node = 10, .count = 4, .grant_numbers = true}, end_, Time(0)};
  std::vector<EscNode> escs_;
  std::vector<transport::FrameBus*> ends_;
  Time now_{0};
};

TEST_F(AllocationOnABusTest, GivesEveryNodeANumberOfItsOwnAndThenTheyFly) {
  controller_.set_armed(true);
  run(milliseconds(500));
  EXPECT_THAT(numbers(), ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(escs_[0].command(now_).condition, EscCondition::kNeverCommanded)
      << "without a number it takes no commands";
  run(seconds(20));
  EXPECT_THAT(numbers(), ::testing::UnorderedElementsAre(122, 123, 124, 125));
  for (std::size_t motor = 0; motor < 4; ++motor) {
    EXPECT_TRUE(controller_.motor_ready(motor, now_));
    EXPECT_NEAR(escs_[motor].command(now_).throttle, 0.1 * static_cast<double>(motor + 1), 1.0 / 8191);
  }
}

TEST_F(AllocationOnABusTest, LetsANodeAskAgainThatIsToldToRestart) {
  run(seconds(20));
  const std::vector<int> before = numbers();
  NodePort tool(127, {}, std::array{RestartNodeRequest::kType.key}, false);
  transport::FrameBus& tool_end = bus_.attach();
  tool.send(RestartNodeRequest{RestartNodeRequest::kMagicNumber}, 24, now_,
            static_cast<std::uint8_t>(before[1]));
  tool.flush(now_, tool_end);
  run(milliseconds(10));
  EXPECT_EQ(numbers()[1], 0);
  run(seconds(10));
  EXPECT_EQ(numbers(), before);
}

TEST_F(AllocationOnABusTest, GivesARestartedNodeItsNumberAgain) {
  run(seconds(20));
  const std::vector<int> before = numbers();
  escs_[2] = EscNode({.node = 0, .esc_index = 2}, now_);
  run(seconds(10));
  EXPECT_EQ(numbers(), before);
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
