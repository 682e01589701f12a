// On a real unit a pass of the control loop takes no memory while nothing happens that is written down as an
// event: from the bytes of an IMU frame to the command's, with judging, and recording in the background.
// docs/safety.md, R7.

#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>

#include "scenarios/bench/test/live_rig.hpp"
#include "simulator/plant/test/counted_malloc.hpp"

namespace ironbird::scenarios {
namespace {

/// What the other end and the line between take is not the bench's.
long elsewhere = 0;

template <class Work>
auto not_counted(Work&& work) {
  struct Account {
    long before = calls_of_malloc;
    ~Account() { elsewhere += calls_of_malloc - before; }
  } const account;
  return work();
}

class FreeLine final : public hil_bridge::transport::ByteStream {
 public:
  explicit FreeLine(ByteStream& line) : line_(line) {}
  std::size_t read(std::span<std::uint8_t> to) override {
    return not_counted([&] { return line_.read(to); });
  }
  std::size_t write(std::span<const std::uint8_t> from) override {
    return not_counted([&] { return line_.write(from); });
  }
  bool is_up() const override { return line_.is_up(); }
  bool reopen() override { return line_.reopen(); }
  std::string name() const override { return line_.name(); }

 private:
  ByteStream& line_;
};

class FreeClock final : public hil_bridge::Clock {
 public:
  explicit FreeClock(Clock& clock) : clock_(clock) {}
  hil_bridge::Time now() override { return clock_.now(); }
  void wait(int descriptor, hil_bridge::Time until) override {
    not_counted([&] { clock_.wait(descriptor, until); });
  }

 private:
  Clock& clock_;
};

TEST(LiveCostTest, TakesNoMemoryInFlight) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("ironbird_live_cost_" + std::to_string(getpid()) + ".mcap");
  test::LiveRig rig;
  rig.options.log_file = file;
  FreeLine line(rig.line.near());
  FreeClock clock(rig.there());
  LiveBench bench(rig.loaded, rig.modules, rig.options, line, clock);
  while (rig.there().now() < std::chrono::seconds(25)) bench.pass();
  ASSERT_LT(rig.there().world().truth().p_NB_N.z(), -2.0) << "the vehicle was meant to fly";
  int eventful = 0;
  constexpr int kPasses = 4000;
  for (int i = 0; i < kPasses; ++i) {
    const std::size_t events = bench.event_count();
    const long before = calls_of_malloc - elsewhere;
    bench.pass();
    if (bench.event_count() != events) {
      ++eventful;
      continue;
    }
    ASSERT_EQ(calls_of_malloc - elsewhere - before, 0) << "in pass " << i;
  }
  EXPECT_LE(eventful, 3);
  bench.close_gate();
  EXPECT_EQ(bench.finish(0.0).outcome, Outcome::kFail) << "it did not fly the whole story";
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace ironbird::scenarios
