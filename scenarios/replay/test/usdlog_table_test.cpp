// Logs of a Crazyflie by hand: which record becomes which row, and what of a damaged one is read.

#include "scenarios/replay/usdlog_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <string>
#include <vector>

namespace ironbird::scenarios {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Rows = std::vector<std::vector<double>>;
using testing::HasSubstr;

/// Two types of record: `imu` with a float and a signed short, `pose` with a byte.
class UsdlogByHand {
 public:
  UsdlogByHand() {
    put(0xBC, 1);
    put(2, 2);
    put(2, 2);
    put(65535, 2);
    text("imu");
    put(2, 2);
    text("acc.z(f)");
    text("raw(h)");
    put(8, 2);
    text("pose");
    put(1, 2);
    text("quality(B)");
  }
  UsdlogByHand& imu(std::uint64_t stamp, float force, std::int16_t raw) {
    put(65535, 2);
    put(stamp, 8);
    put(std::bit_cast<std::uint32_t>(force), 4);
    put(static_cast<std::uint16_t>(raw), 2);
    return *this;
  }
  UsdlogByHand& pose(std::uint64_t stamp, std::uint8_t quality) {
    put(8, 2);
    put(stamp, 8);
    put(quality, 1);
    return *this;
  }
  UsdlogByHand& put(std::uint64_t value, std::size_t width) {
    for (std::size_t k = 0; k < width; ++k) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
    return *this;
  }
  Bytes bytes() const {
    Bytes all = bytes_;
    all.insert(all.end(), 4, 0);  // the check sum
    return all;
  }
  UsdlogTable table(const std::string& record) const { return {bytes(), "fly.usdlog", record}; }

 private:
  void text(const std::string& text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
  }
  Bytes bytes_;
};

TEST(UsdlogTableTest, ReadsTheRecordsOfOneType) {
  const UsdlogByHand log = UsdlogByHand().imu(1000, 0.5F, -3).pose(1500, 7).imu(2000, 1.0F, 4);
  EXPECT_EQ(log.table("imu").numbers({"timestamp", "raw", "acc.z"}).rows,
            (Rows{{1000.0, -3.0, 0.5}, {2000.0, 4.0, 1.0}}));
  EXPECT_EQ(log.table("pose").numbers({"quality"}).rows, (Rows{{7.0}}));
}

TEST(UsdlogTableTest, LeavesOutWhatIsNoNumber) {
  const TableNumbers found = UsdlogByHand()
                                 .imu(1, std::numeric_limits<float>::quiet_NaN(), 0)
                                 .imu(2, 1.0F, 0)
                                 .table("imu")
                                 .numbers({"acc.z"});
  EXPECT_EQ(found.rows, (Rows{{1.0}}));
  EXPECT_EQ(found.left_out, 1U);
  EXPECT_EQ(found.first_left_out, "fly.usdlog: record 1: column 'acc.z' is no number");
}

TEST(UsdlogTableTest, SaysWhatThereIsNot) {
  const UsdlogByHand log = UsdlogByHand().imu(1, 1.0F, 0);
  EXPECT_THROW(
      {
        try {
          log.table("imo");
        } catch (const TableError& error) {
          EXPECT_STREQ(error.what(), "fly.usdlog: there is no type of record 'imo'; did you mean 'imu'?");
          throw;
        }
      },
      TableError);
  EXPECT_THROW(log.table("").numbers({"raw"}), TableError) << "there are two types";
  EXPECT_THROW(log.table("imu").numbers({"acc.x"}), TableError);
}

TEST(UsdlogTableTest, EndsWhereATypeIsNotKnown) {
  const TableNumbers found =
      UsdlogByHand().imu(1, 1.0F, 0).put(17, 2).imu(2, 1.0F, 0).table("imu").numbers({"raw"});
  EXPECT_EQ(found.rows.size(), 1U);
  EXPECT_THAT(found.first_left_out, HasSubstr("a type that the header does not tell"));
}

// Cut at any byte: an error, or the whole records before the cut.
TEST(UsdlogTableTest, ReadsWhatIsWholeOfACutLog) {
  const UsdlogByHand log = UsdlogByHand().imu(1, 1.0F, 1).imu(2, 2.0F, 2).imu(3, 3.0F, 3);
  const Bytes whole = log.bytes();
  constexpr std::size_t kRecord = 2 + 8 + 4 + 2;
  const std::size_t header = whole.size() - 4 - 3 * kRecord;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    if (size < header + 4) {
      EXPECT_THROW(UsdlogTable(cut, "cut", "imu"), TableError) << size;
      continue;
    }
    const TableNumbers found = UsdlogTable(cut, "cut", "imu").numbers({"raw"});
    EXPECT_EQ(found.rows.size(), (size - 4 - header) / kRecord) << size;
    EXPECT_EQ(found.left_out, (size - 4 - header) % kRecord == 0 ? 0U : 1U) << size;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
