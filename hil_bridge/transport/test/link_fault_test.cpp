#include "hil_bridge/transport/link_fault.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "hil_bridge/transport/stream_pair.hpp"

namespace ironbird::hil_bridge::transport {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using Bytes = std::vector<std::uint8_t>;

/// A line with faults at its near end, and what arrives at the far one.
class FaultyLine {
 public:
  explicit FaultyLine(const DirectionFaults& outgoing, std::uint64_t seed = 1)
      : fault_(pair_.near(), {outgoing, {}}, seed) {}

  void send(const Bytes& piece, nanoseconds at) {
    fault_.advance(at);
    fault_.write(piece);
  }
  Bytes arrived(nanoseconds at) {
    fault_.advance(at);
    Bytes bytes(1U << 16U);
    bytes.resize(pair_.far().read(bytes));
    return bytes;
  }
  LinkFault& fault() { return fault_; }
  StreamPair& pair() { return pair_; }

 private:
  StreamPair pair_;
  LinkFault fault_;
};

constexpr int kPieces = 20'000;
/// Pieces of one byte, a millisecond apart, of which the mean is asked: three standard deviations of a coin.
double allowed(double probability) {
  return 3.0 * std::sqrt(probability * (1.0 - probability) / kPieces);
}

double arriving_fraction(const DirectionFaults& faults) {
  FaultyLine line(faults);
  std::size_t arrived = 0;
  for (int k = 0; k < kPieces; ++k) {
    line.send({7}, milliseconds(k));
    arrived += line.arrived(milliseconds(k)).size();
  }
  return static_cast<double>(arrived) / kPieces;
}

TEST(LinkFaultTest, ChangesNothingWithoutFaults) {
  FaultyLine line({});
  line.send({1, 2, 3}, milliseconds(1));
  EXPECT_EQ(line.arrived(milliseconds(1)), (Bytes{1, 2, 3}));
  line.pair().far().write(Bytes{9, 8});
  line.fault().advance(milliseconds(2));
  Bytes back(1);
  EXPECT_EQ(line.fault().read(back), 1U);
  EXPECT_EQ(back[0], 9);
  EXPECT_EQ(line.fault().read(back), 1U);
  EXPECT_EQ(back[0], 8);
}

TEST(LinkFaultTest, LosesTheShareOfPiecesThatItSays) {
  EXPECT_NEAR(arriving_fraction({.drop = 0.2}), 0.8, allowed(0.2));
  EXPECT_EQ(arriving_fraction({.drop = 1.0}), 0.0);
}

TEST(LinkFaultTest, LosesInBurstsOfTheMeanLengthThatItSays) {
  FaultyLine line({.burst_start = 0.01, .burst_end = 0.1});
  int bursts = 0;
  int lost = 0;
  bool before = true;
  for (int k = 0; k < kPieces; ++k) {
    line.send({7}, milliseconds(k));
    const bool here = !line.arrived(milliseconds(k)).empty();
    lost += here ? 0 : 1;
    bursts += !here && before ? 1 : 0;
    before = here;
  }
  EXPECT_NEAR(static_cast<double>(lost) / bursts, 10.0, 2.5);
  EXPECT_NEAR(bursts, kPieces * 0.01 * (1.0 - 0.0909), 45.0);
}

TEST(LinkFaultTest, SpoilsOneBitOfTheShareOfBytesThatItSays) {
  FaultyLine line({.corrupt = 0.05});
  int spoilt = 0;
  for (int k = 0; k < kPieces / 10; ++k) {
    line.send(Bytes(10, 0), milliseconds(k));
    for (const std::uint8_t byte : line.arrived(milliseconds(k))) {
      EXPECT_LE(__builtin_popcount(byte), 1);
      spoilt += byte != 0 ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(spoilt) / kPieces, 0.05, allowed(0.05));
}

TEST(LinkFaultTest, InsertsNoiseBeforeAPieceAndDuplicatesPiecesWhole) {
  FaultyLine noisy({.insert = 1.0});
  noisy.send({200, 201}, milliseconds(1));
  const Bytes bytes = noisy.arrived(milliseconds(1));
  ASSERT_GE(bytes.size(), 3U);
  ASSERT_LE(bytes.size(), 18U);
  EXPECT_EQ(Bytes(bytes.end() - 2, bytes.end()), (Bytes{200, 201}));
  FaultyLine twice({.duplicate = 1.0});
  twice.send({1, 2}, milliseconds(1));
  EXPECT_EQ(twice.arrived(milliseconds(1)), (Bytes{1, 2, 1, 2}));
}

TEST(LinkFaultTest, LetsAPiecePassTheOneBeforeIt) {
  FaultyLine line({.reorder = 1.0, .latency = milliseconds(5)});
  line.send({1}, milliseconds(1));
  line.send({2}, milliseconds(2));
  EXPECT_EQ(line.arrived(milliseconds(6)), Bytes{2});
  EXPECT_EQ(line.arrived(milliseconds(7)), Bytes{1});
}

TEST(LinkFaultTest, DelaysByLatencyAndJitterAndKeepsTheOrder) {
  FaultyLine line({.latency = milliseconds(4), .jitter = milliseconds(10)});
  for (int k = 0; k < 100; ++k) line.send({static_cast<std::uint8_t>(k)}, milliseconds(k));
  Bytes all;
  for (int at = 0; at <= 120; ++at) {
    const Bytes now = line.arrived(milliseconds(at + 100));
    all.insert(all.end(), now.begin(), now.end());
  }
  ASSERT_EQ(all.size(), 100U);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(all[static_cast<std::size_t>(k)], k);
  FaultyLine exact({.latency = milliseconds(4)});
  exact.send({1}, milliseconds(10));
  EXPECT_TRUE(exact.arrived(milliseconds(14) - nanoseconds(1)).empty());
  EXPECT_EQ(exact.arrived(milliseconds(14)), Bytes{1});
}

TEST(LinkFaultTest, CarriesNoMoreBytesASecondThanItSays) {
  FaultyLine line({.byte_rate = 1000.0});
  for (int k = 0; k < 5; ++k) line.send(Bytes(100, 1), milliseconds(0));
  EXPECT_EQ(line.arrived(milliseconds(99)).size(), 0U);
  EXPECT_EQ(line.arrived(milliseconds(100)).size(), 100U);
  EXPECT_EQ(line.arrived(milliseconds(499)).size(), 300U);
  EXPECT_EQ(line.arrived(milliseconds(500)).size(), 100U);
}

TEST(LinkFaultTest, StandsStillAndGoesOn) {
  FaultyLine line({.stall = 1.0, .stall_time = milliseconds(50)});
  line.send({1}, milliseconds(10));
  EXPECT_TRUE(line.arrived(milliseconds(59)).empty());
  EXPECT_EQ(line.arrived(milliseconds(60)), Bytes{1});
}

TEST(LinkFaultTest, IsCutAndComesBackWithNothingOfBefore) {
  FaultyLine line({.latency = milliseconds(10), .hang_up = 1.0});
  line.send({1, 2, 3}, milliseconds(1));
  EXPECT_FALSE(line.fault().is_up());
  EXPECT_EQ(line.fault().write(Bytes{4}), 0U);
  EXPECT_TRUE(line.arrived(milliseconds(30)).empty());
  EXPECT_TRUE(line.fault().reopen());
  EXPECT_TRUE(line.fault().is_up());
  EXPECT_TRUE(line.arrived(milliseconds(60)).empty());
}

TEST(LinkFaultTest, StaysCutForAsLongAsItIsTold) {
  FaultyLine line({});
  line.send({1}, milliseconds(1));
  line.fault().hang_up(milliseconds(500));
  line.pair().far().write(Bytes{9});
  line.fault().advance(milliseconds(499));
  EXPECT_FALSE(line.fault().reopen());
  line.fault().advance(milliseconds(500));
  EXPECT_TRUE(line.fault().reopen());
  Bytes back(1);
  EXPECT_EQ(line.fault().read(back), 0U) << "what came while it was cut is gone";
}

TEST(LinkFaultTest, StandsStillBothWaysWhenToldAndLosesNothing) {
  FaultyLine line({});
  line.fault().advance(milliseconds(1));
  line.fault().stand_still(milliseconds(50));
  line.fault().write(Bytes{1});
  line.pair().far().write(Bytes{9});
  EXPECT_TRUE(line.arrived(milliseconds(49)).empty());
  Bytes back(1);
  EXPECT_EQ(line.fault().read(back), 0U);
  EXPECT_EQ(line.arrived(milliseconds(50)), Bytes{1});
  EXPECT_EQ(line.fault().read(back), 1U);
}

TEST(LinkFaultTest, TakesOtherFaultsInTheMiddle) {
  FaultyLine line({});
  line.fault().set({{.drop = 1.0}, {}});
  line.send({1}, milliseconds(1));
  line.fault().set({});
  line.send({2}, milliseconds(2));
  EXPECT_EQ(line.arrived(milliseconds(3)), Bytes{2});
  EXPECT_THROW(line.fault().set({{.drop = -1.0}, {}}), std::invalid_argument);
}

/// Pieces of three bytes.
std::size_t three(std::span<const std::uint8_t> bytes) {
  return bytes.size() < 3 ? 0 : 3;
}

TEST(LinkFaultTest, LosesWholePiecesOfWhatItReadsHoweverTheyCome) {
  Bytes heard[2];
  for (const std::size_t at_once : {1U, 7U}) {
    StreamPair pair;
    LinkFault fault(pair.near(), {{}, {.drop = 0.5}}, 1, three);
    Bytes all(3000);
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<std::uint8_t>(k / 3);
    for (std::size_t k = 0; k < all.size(); k += at_once) {
      pair.far().write(std::span(all).subspan(k, std::min(at_once, all.size() - k)));
      fault.advance(milliseconds(k));
    }
    Bytes& out = heard[at_once == 1 ? 0 : 1];
    out.resize(all.size());
    out.resize(fault.read(out));
  }
  EXPECT_EQ(heard[0], heard[1]);
  ASSERT_GT(heard[0].size(), 1200U);
  ASSERT_LT(heard[0].size(), 1800U);
  for (std::size_t k = 0; k < heard[0].size(); k += 3) EXPECT_EQ(heard[0][k], heard[0][k + 2]);
}

TEST(LinkFaultTest, LosesWholePiecesOfWhatItWritesHoweverTheyAreWritten) {
  Bytes heard[2];
  for (const std::size_t at_once : {2U, 9U}) {
    StreamPair pair;
    LinkFault fault(pair.near(), {{.drop = 0.5}, {}}, 1, three);
    Bytes all(3000);
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<std::uint8_t>(k / 3);
    for (std::size_t k = 0; k < all.size(); k += at_once) {
      const std::size_t count = std::min(at_once, all.size() - k);
      EXPECT_EQ(fault.write(std::span(all).subspan(k, count)), count);
    }
    Bytes& out = heard[at_once == 2 ? 0 : 1];
    out.resize(all.size());
    out.resize(pair.far().read(out));
  }
  EXPECT_EQ(heard[0], heard[1]);
  ASSERT_GT(heard[0].size(), 1200U);
  ASSERT_LT(heard[0].size(), 1800U);
  for (std::size_t k = 0; k < heard[0].size(); k += 3) EXPECT_EQ(heard[0][k], heard[0][k + 2]);
}

// What nobody reads must not be kept: a program that comes later would take it for what is said now.
TEST(LinkFaultTest, TakesNoMoreThanTheLineBehindItWhileNobodyReads) {
  constexpr std::size_t kRoom = 1000;
  StreamPair pair(kRoom);
  LinkFault fault(pair.near(), {}, 1);
  std::size_t taken = 0;
  for (int k = 0; k < 100; ++k) {
    fault.advance(milliseconds(k));
    taken += fault.write(Bytes(100, static_cast<std::uint8_t>(k)));
  }
  EXPECT_LE(taken, kRoom + 100);
  Bytes all(2 * kRoom);
  EXPECT_EQ(pair.far().read(all), kRoom);
  fault.advance(milliseconds(100));
  EXPECT_EQ(fault.write(Bytes(100, 7)), 100U) << "somebody has read";
}

TEST(LinkFaultTest, HoldsNoMoreForASlowLineThanADriverDoes) {
  FaultyLine line({.byte_rate = 1000.0});
  std::size_t taken = 0;
  for (int k = 0; k < 1000; ++k) taken += line.fault().write(Bytes(100, 1));
  EXPECT_GE(taken, 4000U);
  EXPECT_LE(taken, 4200U);
  line.fault().advance(milliseconds(1000));
  EXPECT_EQ(line.fault().write(Bytes(100, 1)), 100U);
}

TEST(LinkFaultTest, ForgetsWhatWasUnderWayWhenTheLineBehindItWasCut) {
  StreamPair pair;
  LinkFault fault(pair.near(), {{.latency = milliseconds(50)}, {}}, 1, three);
  fault.advance(milliseconds(0));
  fault.write(Bytes{1, 1, 1, 2});
  pair.far().write(Bytes{5});
  fault.advance(milliseconds(10));
  pair.hang_up();
  ASSERT_FALSE(fault.is_up());
  ASSERT_TRUE(pair.far().reopen());
  ASSERT_TRUE(fault.reopen());
  fault.write(Bytes{3, 3, 3});
  pair.far().write(Bytes{6, 6, 6});
  fault.advance(milliseconds(100));
  Bytes there(10), here(10);
  there.resize(pair.far().read(there));
  here.resize(fault.read(here));
  EXPECT_EQ(there, (Bytes{3, 3, 3}));
  EXPECT_EQ(here, (Bytes{6, 6, 6}));
}

TEST(LinkFaultTest, HasTheSameFaultsForTheSameSeedAndOthersForAnother) {
  const DirectionFaults faults{.drop = 0.1, .corrupt = 0.01, .insert = 0.1, .duplicate = 0.1};
  std::map<std::uint64_t, Bytes> runs[2];
  for (auto& run : runs) {
    for (const std::uint64_t seed : {1U, 2U}) {
      FaultyLine line(faults, seed);
      for (int k = 0; k < 500; ++k) line.send(Bytes(5, static_cast<std::uint8_t>(k)), milliseconds(k));
      run[seed] = line.arrived(milliseconds(1000));
    }
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_NE(runs[0][1], runs[0][2]);
}

TEST(LinkFaultTest, RefusesProbabilitiesBeyondOne) {
  StreamPair pair;
  try {
    const LinkFault fault(pair.near(), {{.drop = 1.5}, {}}, 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "link_fault.drop = 1.5, must be between 0 and 1");
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
