// Tables by hand: what is a line, a name, a field and a number, and what is said of the rest.

#include "scenarios/replay/text_table.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ironbird::scenarios {
namespace {

using Rows = std::vector<std::vector<double>>;
using Names = std::vector<std::string>;

TableNumbers numbers(const std::string& text, const Names& columns, TableLayout layout = {}) {
  return TextTable(text, "flight.csv", std::move(layout)).numbers(columns);
}

std::string complaint(const std::string& text, const Names& columns, TableLayout layout = {}) {
  try {
    numbers(text, columns, std::move(layout));
  } catch (const TableError& error) {
    return error.what();
  }
  return "none";
}

TEST(TextTableTest, ReadsColumnsInTheOrderAsked) {
  EXPECT_EQ(numbers("t,a,b\n0,1,2\n0.5,-3e-1,+4\n", {"b", "t"}).rows, (Rows{{2.0, 0.0}, {4.0, 0.5}}));
}

TEST(TextTableTest, TakesNamesAndFieldsWithoutWhatIsAroundThem) {
  EXPECT_EQ(numbers("\xEF\xBB\xBFt , roll(degrees)\r\n 1 , 2 \r\n", {"t", "roll(degrees)"}).rows,
            (Rows{{1.0, 2.0}}));
  EXPECT_EQ(numbers("#t,\"a, of all\"\n\n# a remark\n1,\"2\"", {"t", "a, of all"}).rows, (Rows{{1.0, 2.0}}));
}

TEST(TextTableTest, SplitsByOtherDelimiters) {
  EXPECT_EQ(numbers("t;a\n1;2\n", {"a"}, {.delimiter = ";"}).rows, (Rows{{2.0}}));
  EXPECT_EQ(numbers("t\ta\n1\t2\n", {"a"}, {.delimiter = "\t"}).rows, (Rows{{2.0}}));
  EXPECT_EQ(numbers("  t   a\n 1     2  \n", {"t", "a"}, {.delimiter = " "}).rows, (Rows{{1.0, 2.0}}));
}

TEST(TextTableTest, PassesWhatStandsInFrontOfEveryLine) {
  const std::string log =
      "[12:00] [7] [Log] Time [s], Position x [m],\n"
      "[12:00] [9] [Other] 5, 6,\n"
      "[12:01] [7] [Log] 1, 2,\n"
      "cut [Log]\n";
  const TableLayout layout{.lines_with = "[Log]", .skip_past = "] ", .skip_count = 3};
  EXPECT_EQ(numbers(log, {"Time [s]", "Position x [m]"}, layout).rows, (Rows{{1.0, 2.0}}));
}

TEST(TextTableTest, TakesNamesFromElsewhereWhereTheFileHasNone) {
  EXPECT_EQ(numbers("1,2\n3,4\n", {"t"}, {.header = {"t", "a"}}).rows, (Rows{{1.0}, {3.0}}));
}

struct BadRow {
  const char* row;
  const char* complaint;
};
class TextTableBadRowTest : public testing::TestWithParam<BadRow> {};

TEST_P(TextTableBadRowTest, IsLeftOutAndCounted) {
  const TableNumbers found =
      numbers("t,a,b\n0,1,2\n" + std::string(GetParam().row) + "\n,,\n2,3,4\n", {"t", "b"});
  EXPECT_EQ(found.rows, (Rows{{0.0, 2.0}, {2.0, 4.0}}));
  EXPECT_EQ(found.left_out, 2U);
  EXPECT_EQ(found.first_left_out, std::string("flight.csv:3: ") + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(Known, TextTableBadRowTest,
                         testing::Values(BadRow{"1,2", "has 2 fields; column 'b' is number 3"},
                                         BadRow{"1", "has 1 fields; column 'b' is number 3"},
                                         BadRow{"1,2,x", "column 'b' is no number: 'x'"},
                                         BadRow{"1,2,", "column 'b' is no number: ''"},
                                         BadRow{"nan,2,3", "column 't' is no number: 'nan'"},
                                         BadRow{"1,2,inf", "column 'b' is no number: 'inf'"},
                                         BadRow{"1,2,1e999", "column 'b' is no number: '1e999'"},
                                         BadRow{"1,2,3m", "column 'b' is no number: '3m'"},
                                         BadRow{"1,2,\"3", "column 'b' is no number: '\"3'"}));

TEST(TextTableTest, LeavesAloneWhatWasNotAskedFor) {
  EXPECT_EQ(numbers("t,name\n1,take-off\n", {"t"}).left_out, 0U);
}

TEST(TextTableTest, SaysWhichColumnThereIsNot) {
  EXPECT_EQ(complaint("time,Gyr_X\n1,2\n", {"Gyr_x"}),
            "flight.csv:1: there is no column 'Gyr_x'; did you mean 'Gyr_X'?");
  EXPECT_EQ(complaint("time,a\n1,2\n", {"pressure"}),
            "flight.csv:1: there is no column 'pressure'; there are: time, a");
}

TEST(TextTableTest, SaysWhatIsNoTable) {
  EXPECT_EQ(complaint("", {"t"}), "flight.csv: is empty");
  EXPECT_EQ(complaint("\n\n", {"t"}), "flight.csv: has no line");
  EXPECT_EQ(complaint("t,a\n", {"t"}, {.lines_with = "[Log]"}),
            "flight.csv: has no line of this table; see its lines_with, skip_past and skip_count");
  EXPECT_EQ(complaint(std::string("ULog\0\1", 6), {"t"}),
            "flight.csv: is no text; a column map reads tables of text");
}

}  // namespace
}  // namespace ironbird::scenarios
