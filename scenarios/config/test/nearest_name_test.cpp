#include "scenarios/config/nearest_name.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace ironbird::scenarios {
namespace {

struct DistanceCase {
  const char* a;
  const char* b;
  std::size_t distance;
};
class EditDistanceTest : public ::testing::TestWithParam<DistanceCase> {};

TEST_P(EditDistanceTest, CountsChangesEitherWay) {
  EXPECT_EQ(edit_distance(GetParam().a, GetParam().b), GetParam().distance);
  EXPECT_EQ(edit_distance(GetParam().b, GetParam().a), GetParam().distance);
}

INSTANTIATE_TEST_SUITE_P(Words, EditDistanceTest,
                         ::testing::Values(DistanceCase{"", "", 0}, DistanceCase{"", "abc", 3},
                                           DistanceCase{"step", "step", 0}, DistanceCase{"step", "stop", 1},
                                           DistanceCase{"step", "steps", 1}, DistanceCase{"step", "setp", 1},
                                           DistanceCase{"kitten", "sitting", 3}));

TEST(NearestNameTest, FindsWhatWasMeant) {
  const std::vector<std::string> known{"heading", "heading_rate", "speed", "p_N"};
  EXPECT_EQ(nearest_name("headign", known), "heading");
  EXPECT_EQ(nearest_name("heading_rte", known), "heading_rate");
  EXPECT_EQ(nearest_name("p_n", known), "p_N");
  EXPECT_EQ(nearest_name("velocity", known), "");
}

TEST(NearestNameTest, TakesTheFirstOfEquals) {
  EXPECT_EQ(nearest_name("bat", std::vector<std::string>{"cat", "rat"}), "cat");
}

}  // namespace
}  // namespace ironbird::scenarios
