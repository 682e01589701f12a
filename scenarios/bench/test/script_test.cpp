#include "scenarios/bench/script.hpp"

#include <gtest/gtest.h>

namespace ironbird::scenarios {
namespace {

using std::chrono::seconds;

std::vector<std::size_t> all_due(Script& script, Script::Time now) {
  std::vector<std::size_t> items;
  while (const auto item = script.next_due(now)) items.push_back(*item);
  return items;
}

TEST(ScriptTest, GivesOutItemsAtTheirTimeAndOnce) {
  Script script;
  script.add("", seconds(2));
  script.add("", seconds(1));
  EXPECT_TRUE(all_due(script, seconds(0)).empty());
  EXPECT_EQ(all_due(script, seconds(1)), (std::vector<std::size_t>{1}));
  EXPECT_EQ(all_due(script, seconds(5)), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(all_due(script, seconds(9)).empty());
}

TEST(ScriptTest, KeepsTheOrderOfTheFileForEqualTimes) {
  Script script;
  script.add("", seconds(1));
  script.add("", seconds(1));
  script.add("", seconds(0));
  EXPECT_EQ(all_due(script, seconds(1)), (std::vector<std::size_t>{2, 0, 1}));
}

TEST(ScriptTest, CountsFromTheFirstEventOfAName) {
  Script script;
  script.add("take_off", seconds(3));
  EXPECT_TRUE(all_due(script, seconds(100)).empty());
  script.happened("take_off", seconds(10));
  script.happened("take_off", seconds(20));
  EXPECT_TRUE(all_due(script, seconds(12)).empty());
  EXPECT_EQ(all_due(script, seconds(13)), (std::vector<std::size_t>{0}));
}

TEST(ScriptTest, KeepsBackAtTheEndWhatBelongsBeforeIt) {
  using enum Script::Role;
  Script script;
  script.add("", seconds(1), kBeforeTheEnd);
  script.add("", seconds(2), kBeforeTheEnd);
  script.add("", seconds(2), kIndifferent);
  script.add("", seconds(2), kEnd);
  EXPECT_EQ(all_due(script, seconds(1)), (std::vector<std::size_t>{0}));
  EXPECT_EQ(all_due(script, seconds(2)), (std::vector<std::size_t>{2, 3}));
  ASSERT_EQ(script.left().size(), 1U);
  EXPECT_EQ(script.left()[0].item, 1U);
}

TEST(ScriptTest, EndsWithTheFirstEndThatIsDue) {
  using enum Script::Role;
  Script script;
  script.add("", seconds(9), kEnd);
  script.add("landed", seconds(0), kBeforeTheEnd);
  script.add("landed", seconds(0), kEnd);
  script.happened("landed", seconds(3));
  EXPECT_EQ(all_due(script, seconds(3)), (std::vector<std::size_t>{2}));
  EXPECT_EQ(script.left().size(), 2U);
}

TEST(ScriptTest, TellsWhatIsLeft) {
  Script script;
  script.add("b", seconds(0));
  script.add("a", seconds(0));
  script.add("b", seconds(9));
  EXPECT_EQ(script.left().size(), 3U);
  script.happened("b", seconds(1));
  EXPECT_EQ(all_due(script, seconds(2)), (std::vector<std::size_t>{0}));
  const std::vector<Script::Left> left = script.left();
  ASSERT_EQ(left.size(), 2U);
  EXPECT_EQ(left[0].item, 1U);
  EXPECT_EQ(left[0].after, "a");
  EXPECT_FALSE(left[0].due);
  EXPECT_EQ(left[1].item, 2U);
  EXPECT_EQ(left[1].due, seconds(10));
}

}  // namespace
}  // namespace ironbird::scenarios
