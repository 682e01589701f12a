#include "scenarios/bench/link_faults.hpp"

#include <gtest/gtest.h>

#include "scenarios/bench/run_time.hpp"

namespace ironbird::scenarios {
namespace {

/// Remembers what it was told.
struct ToldLink {
  void set(const hil_bridge::transport::LinkFaultConfig& config) { faults = config; }
  void stand_still(std::chrono::nanoseconds until) { still_until = until; }
  void hang_up(std::chrono::nanoseconds until) { cut_until = until; }

  hil_bridge::transport::LinkFaultConfig faults;
  std::chrono::nanoseconds still_until{};
  std::chrono::nanoseconds cut_until{};
};

TEST(RunningLinkFaultsTest, ActBothWaysAndLeaveWhatIsAlwaysThere) {
  hil_bridge::transport::LinkFaultConfig always;
  always.outgoing.drop = 0.1;
  RunningLinkFaults faults(always);
  ToldLink link;
  faults.begin(0, LinkFaultKind::kDrop, 0.5, {}, link);
  faults.begin(1, LinkFaultKind::kLatency, 0.02, {}, link);
  EXPECT_EQ(link.faults.outgoing.drop, 0.5);
  EXPECT_EQ(link.faults.incoming.drop, 0.5);
  EXPECT_EQ(link.faults.incoming.latency, from_seconds(0.02));
  faults.end(0, link);
  EXPECT_EQ(link.faults.outgoing.drop, 0.1);
  EXPECT_EQ(link.faults.incoming.drop, 0.0);
  EXPECT_EQ(link.faults.outgoing.latency, from_seconds(0.02));
}

TEST(RunningLinkFaultsTest, CoverAnEarlierOneOfTheirKindUntilTheyEnd) {
  RunningLinkFaults faults({});
  ToldLink link;
  faults.begin(3, LinkFaultKind::kCorrupt, 0.1, {}, link);
  faults.begin(4, LinkFaultKind::kCorrupt, 0.2, {}, link);
  EXPECT_EQ(link.faults.incoming.corrupt, 0.2);
  faults.end(4, link);
  EXPECT_EQ(link.faults.incoming.corrupt, 0.1);
  faults.end(3, link);
  EXPECT_EQ(link.faults.incoming.corrupt, 0.0);
}

TEST(RunningLinkFaultsTest, ReachEveryFaultThatALineCanHave) {
  for (const auto& [kind, name] : enumerators(LinkFaultKind{})) {
    RunningLinkFaults faults({});
    ToldLink link;
    faults.begin(0, kind, 0.5, from_seconds(3.0), link);
    const auto& f = link.faults.outgoing;
    const double sum = f.drop + f.burst_start + f.corrupt + f.insert + f.duplicate + f.reorder + f.byte_rate +
                       to_seconds(f.latency) + to_seconds(f.jitter);
    const bool told = kind == LinkFaultKind::kStall    ? link.still_until == from_seconds(3.0)
                      : kind == LinkFaultKind::kHangUp ? link.cut_until == from_seconds(3.0)
                                                       : sum == 0.5;
    EXPECT_TRUE(told) << name;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
