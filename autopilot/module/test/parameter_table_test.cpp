#include "autopilot/module/parameter_table.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "autopilot/module/module.hpp"
#include "autopilot/module/registry.hpp"
#include "autopilot/module/tunable.hpp"

namespace ironbird::autopilot {
namespace {

struct InnerParams {
  double gain = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("gain", self.gain, "1", "a gain", 0.0, 10.0);
  }
};

struct ExampleParams {
  InnerParams inner;
  int count = 3;
  bool enabled = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("inner", self.inner, "", "nested");
    visit("count", self.count, "1", "a number", 1.0, 5.0);
    visit("enabled", self.enabled, "1", "a flag");
  }
};

struct RangeParams {
  double least = 0.0;
  double most = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("least", self.least, "1", "lower end", 0.0, 10.0);
    visit("most", self.most, "1", "upper end", 0.0, 10.0);
  }

  static std::string_view conflict(const RangeParams& p) {
    return p.least < p.most ? "" : "least must be less than most";
  }
};

class ExampleModule : public Module {
 public:
  void reset() override {}
};

class Example final : public Tunable<ExampleModule, ExampleParams> {
 public:
  int rebuilt = 0;

 protected:
  void on_parameters() override { ++rebuilt; }
};

class Range final : public Tunable<ExampleModule, RangeParams> {};

class ParameterTableTest : public ::testing::Test {
 protected:
  ParameterTableTest() { example_.register_parameters(table_, "slot"); }

  Example example_;
  ParameterTable table_;
};

TEST_F(ParameterTableTest, SetsNestedParametersAndTellsTheModule) {
  EXPECT_EQ(table_.set("slot.inner.gain", 2.5), SetOutcome::kAccepted);
  EXPECT_EQ(example_.params().inner.gain, 2.5);
  EXPECT_EQ(example_.rebuilt, 1);
  EXPECT_EQ(table_.set("slot.inner.gain", 4), SetOutcome::kAccepted) << "a whole number is a number";
  EXPECT_EQ(example_.params().inner.gain, 4.0);
  EXPECT_EQ(table_.set("slot.count", 5), SetOutcome::kAccepted);
  EXPECT_EQ(table_.set("slot.enabled", true), SetOutcome::kAccepted);
  EXPECT_EQ(example_.rebuilt, 4);
}

TEST(ParameterConflictTest, IsRefusedWhenOneValueIsSetAndLeavesItAsItWas) {
  Range range;
  ParameterTable table;
  range.register_parameters(table, "slot");
  std::string conflict;
  EXPECT_EQ(table.set("slot.least", 2.0, false, &conflict), SetOutcome::kConflict);
  EXPECT_EQ(conflict, "least must be less than most");
  EXPECT_EQ(range.params().least, 0.0);
}

TEST(ParameterConflictTest, IsJudgedAtTheEndWhenManyAreSet) {
  Range range;
  ParameterTable table;
  range.register_parameters(table, "slot");
  EXPECT_EQ(table.set_all({{"slot.least", 2.0}, {"slot.most", 3.0}, {"slot.other", 1.0}}), "");
  EXPECT_EQ(table.get("slot.least"), ParameterValue(2.0));
  EXPECT_EQ(table.set_all({{"slot.least", 5.0}, {"slot.most", 4.0}}), "slot.least must be less than most");
}

struct RefusedSet {
  const char* name;
  const char* path;
  ParameterValue value;
  SetOutcome outcome;
};

class RefusedSetTest : public ::testing::TestWithParam<RefusedSet> {};

TEST_P(RefusedSetTest, ChangesNothingAndSaysWhy) {
  Example example;
  ParameterTable table;
  example.register_parameters(table, "slot");
  EXPECT_EQ(table.set(GetParam().path, GetParam().value), GetParam().outcome);
  EXPECT_EQ(example.rebuilt, 0);
  EXPECT_EQ(example.params().inner.gain, 1.0);
  EXPECT_EQ(example.params().count, 3);
  EXPECT_FALSE(example.params().enabled);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, RefusedSetTest,
    ::testing::Values(RefusedSet{"Unknown", "slot.gain", 1.0, SetOutcome::kUnknown},
                      RefusedSet{"OnlyAPrefix", "slot.inner", 1.0, SetOutcome::kUnknown},
                      RefusedSet{"TooGreat", "slot.inner.gain", 10.1, SetOutcome::kOutOfBounds},
                      RefusedSet{"TooSmall", "slot.inner.gain", -0.1, SetOutcome::kOutOfBounds},
                      RefusedSet{"NotFinite", "slot.inner.gain", std::numeric_limits<double>::quiet_NaN(),
                                 SetOutcome::kNotFinite},
                      RefusedSet{"FlagForANumber", "slot.inner.gain", true, SetOutcome::kWrongType},
                      RefusedSet{"FractionForACount", "slot.count", 2.5, SetOutcome::kWrongType},
                      RefusedSet{"CountTooGreat", "slot.count", 6, SetOutcome::kOutOfBounds},
                      RefusedSet{"NumberForAFlag", "slot.enabled", 1, SetOutcome::kWrongType}),
    [](const auto& case_) { return case_.param.name; });

TEST_F(ParameterTableTest, ForgetsOnlyWhatLiesBelowAPrefix) {
  Example other;
  other.register_parameters(table_, "slot_two");
  table_.remove("slot");
  EXPECT_EQ(table_.find("slot.count"), nullptr);
  EXPECT_NE(table_.find("slot_two.count"), nullptr);
}

TEST(RegistryTest, MakesByNameAndListsNamesInOrder) {
  Registry<ExampleModule> registry;
  registry.add<Example>("beta");
  registry.add<Example>("alpha");
  EXPECT_NE(registry.make("beta"), nullptr);
  EXPECT_EQ(registry.make("gamma"), nullptr);
  EXPECT_EQ(registry.names(), (std::vector<std::string>{"alpha", "beta"}));
}

TEST(DividerTest, WorksAtItsPeriodWhateverTheTicks) {
  using std::chrono::microseconds;
  Divider divider;
  double dt = -1.0;
  ASSERT_TRUE(divider.due(Time{0}, microseconds(20000), dt));
  EXPECT_EQ(dt, 0.0);
  int works = 0;
  for (int i = 1; i <= 400; ++i)
    works += divider.due(microseconds(2500 * i), microseconds(20000), dt) ? 1 : 0;
  EXPECT_EQ(works, 50);
  EXPECT_EQ(dt, 0.02);
}

TEST(DividerTest, IsNotHurriedByAGap) {
  using std::chrono::milliseconds;
  Divider divider;
  double dt = 0.0;
  divider.due(milliseconds(0), milliseconds(20), dt);
  EXPECT_TRUE(divider.due(milliseconds(1005), milliseconds(20), dt));
  EXPECT_DOUBLE_EQ(dt, 1.005);
  EXPECT_FALSE(divider.due(milliseconds(1010), milliseconds(20), dt)) << "missed work is not made up for";
  EXPECT_TRUE(divider.due(milliseconds(1025), milliseconds(20), dt));
}

}  // namespace
}  // namespace ironbird::autopilot
