#include "simulator/render/ground_kernel.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace ironbird::simulator {
namespace {

// White lines on black, one pixel every centimetre northwards along a line at east 0.5 m.
GroundRow lines_only() {
  GroundRow row;
  row.north = 200.005F;
  row.north_step = 0.01F;
  row.north_print = 0.01F;
  row.east = 200.5F;
  row.east_print = 0.01F;
  row.fine_lines = 1.0F;
  row.line = {255.0F, 255.0F, 255.0F};
  return row;
}

TEST(GroundKernelTest, ConservesTheAreaOfItsLines) {
  std::vector<Pixel> pixels(400);
  draw_ground(lines_only(), pixels.data(), 400);
  double sum = 0.0;
  for (const Pixel& p : pixels) {
    sum += p.r / 255.0 * 0.01;
  }
  // Four metres hold four lines of 0.025 m; half of the line at the start lies outside, as much comes at the
  // end.
  EXPECT_NEAR(sum, 4.0 * 0.025, 0.002);
}

TEST(GroundKernelTest, BecomesTheMeanForAFootprintOfWholePeriods) {
  GroundRow row = lines_only();
  row.north_step = 0.37F;
  row.north_print = 3.0F;
  std::vector<Pixel> pixels(64);
  draw_ground(row, pixels.data(), 64);
  for (const Pixel& p : pixels) {
    EXPECT_NEAR(p.r, 0.025 * 255.0, 1.0);
  }
}

TEST(GroundKernelTest, DoesNotDependOnWhereARowIsCut) {
  // A vectorised loop treats the last pixels of a row separately.
  GroundRow row = lines_only();
  row.squares = 1.0F;
  row.base = {90.0F, 120.0F, 60.0F};
  row.square = {6.0F, 7.0F, 4.0F};
  row.line = {120.0F, 110.0F, 130.0F};
  row.east_step = 0.013F;
  std::vector<Pixel> whole(67);
  draw_ground(row, whole.data(), 67);
  for (int width = 1; width < 67; ++width) {
    std::vector<Pixel> part(static_cast<std::size_t>(width));
    draw_ground(row, part.data(), width);
    EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin())) << width;
  }
}

TEST(RowRangeTest, HoldsExactlyThePixelsInside) {
  const auto range = row_range(-5.0, 0.5, 0.0, 0.0, 2.0, 100);
  EXPECT_EQ(range.first, 6);    // -5 + 6 * 0.5 = -2
  EXPECT_EQ(range.second, 14);  // -5 + 14 * 0.5 = 2, the first not inside
  EXPECT_EQ(row_range(0.0, 0.1, 3.0, 0.0, 2.0, 100).second, 0);
}

}  // namespace
}  // namespace ironbird::simulator
