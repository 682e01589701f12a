#include "simulator/types/bounds.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {
namespace {

struct Leaf {
  double length = 1.0;
  Vector3 direction = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("length", self.length, "m", "how long", 0.0, 2.0);
    visit("direction", self.direction, "1", "where to");
  }
};

struct Tree {
  int rings = 3;
  std::string name = "oak";
  std::array<double, 2> pair = {0.0, 0.0};
  std::vector<Leaf> leaves = {Leaf{}, Leaf{}};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("rings", self.rings, "1", "how old", 1.0, 1000.0);
    visit("name", self.name, "1", "what it is called");
    visit("pair", self.pair, "m", "two numbers", -1.0, 1.0);
    visit("leaves", self.leaves, "", "what falls in autumn");
  }
};

std::string complaint(const Tree& tree) {
  try {
    check_bounds(tree, "tree");
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(BoundsTest, AcceptsWhatIsWithinAllBounds) {
  EXPECT_EQ(complaint(Tree{}), "");
}

TEST(BoundsTest, NamesPathValueUnitAndBound) {
  Tree tree;
  tree.leaves[1].length = 2.5;
  EXPECT_EQ(complaint(tree), "tree.leaves[1].length = 2.5 m, must be between 0 and 2");
}

TEST(BoundsTest, LooksIntoIntegersArraysAndVectors) {
  Tree tree;
  tree.rings = 0;
  EXPECT_EQ(complaint(tree), "tree.rings = 0, must be between 1 and 1000");
  tree = Tree{};
  tree.pair[1] = -2.0;
  EXPECT_EQ(complaint(tree), "tree.pair[1] = -2 m, must be between -1 and 1");
  tree = Tree{};
  tree.leaves[0].direction.z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaint(tree), "tree.leaves[0].direction[2] = inf, must be finite");
}

TEST(BoundsTest, RefusesWhatIsNoNumberEvenWithoutBounds) {
  Tree tree;
  tree.leaves[0].direction.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(complaint(tree), "");
}

}  // namespace
}  // namespace ironbird::simulator
