// Every message of every recorded flight, by our reader and by somebody else's.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/config/digest.hpp"
#include "scenarios/replay/test/flights.hpp"
#include "scenarios/replay/ulog_file.hpp"

namespace ironbird::scenarios {
namespace {

using nlohmann::json;

std::string output_of(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start: " + command);
  std::string output;
  std::array<char, 65536> part;
  while (const std::size_t count = fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), count);
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command);
  return output;
}

/// The values of a series as the foreign reader's script writes them down.
class Writer {
 public:
  explicit Writer(const UlogSeries& series) : series_(series) {}

  std::string all() {
    for (record_ = 0; record_ < series_.size(); ++record_) fields(*series_.layout(), 0);
    return std::move(bytes_);
  }

 private:
  void fields(const UlogLayout& layout, std::size_t base) {
    for (const UlogLayout::Field& field : layout.fields) {
      if (field.name.starts_with('_')) continue;
      for (std::size_t k = 0; k < field.count; ++k) {
        const std::size_t offset = base + field.offset + k * field.stride();
        if (field.nested != nullptr) {
          fields(*field.nested, offset);
        } else {
          value({offset, field.type, 1});
        }
      }
    }
  }
  void value(const UlogPlace& place) {
    if (place.type == UlogType::kChar) {
      bytes_ += static_cast<char>(series_.integer(record_, place));
    } else if (place.type == UlogType::kInt64 || place.type == UlogType::kUint64) {
      append(static_cast<std::uint64_t>(series_.integer(record_, place)));
    } else {
      const double number = series_.number(record_, place);
      append(std::bit_cast<std::uint64_t>(std::isnan(number) ? std::numeric_limits<double>::quiet_NaN()
                                                             : number));
    }
  }
  void append(std::uint64_t bits) {
    for (unsigned shift = 0; shift < 64; shift += 8) bytes_ += static_cast<char>(bits >> shift & 0xFFU);
  }

  const UlogSeries& series_;
  std::size_t record_ = 0;
  std::string bytes_;
};

class ForeignFlightTest : public testing::TestWithParam<test::KnownFlight> {};

TEST_P(ForeignFlightTest, IsReadAsSomebodyElseReadsIt) {
  IRONBIRD_NEEDS_FLIGHTS();
  const std::filesystem::path path = test::flights_folder() / "px4" / (std::string(GetParam().file) + ".ulg");
  const json theirs = json::parse(output_of(
      "node '" IRONBIRD_SOURCE_DIR "/scenarios/replay/test/foreign/read_ulog.mjs' '" + path.string() + "'"));
  const UlogFile ours = UlogFile::read(path);
  std::size_t messages = 0;
  std::size_t series_with_messages = 0;
  for (const UlogSeries& series : ours.series()) {
    const std::string name = series.topic() + "[" + std::to_string(series.instance()) + "]";
    if (series.size() == 0) {
      EXPECT_FALSE(theirs["series"].contains(name)) << name;
      continue;
    }
    ASSERT_TRUE(theirs["series"].contains(name)) << name;
    EXPECT_EQ(theirs["series"][name]["count"], series.size()) << name;
    EXPECT_EQ(theirs["series"][name]["sha256"], digest(Writer(series).all())) << name;
    messages += series.size();
    ++series_with_messages;
  }
  EXPECT_GT(messages, 10'000U);
  EXPECT_EQ(theirs["series"].size(), series_with_messages) << "theirs has none that ours lacks";
  for (const auto& [name, value] : theirs["parameters"].items()) {
    ASSERT_TRUE(ours.parameter(name)) << name;
    if (value.is_null()) continue;
    EXPECT_EQ(*ours.parameter(name), value.get<double>()) << name;
  }
  EXPECT_EQ(ours.parameters().size(), theirs["parameters"].size());
  for (const auto& [name, value] : theirs["information"].items())
    EXPECT_EQ(ours.information().at(name), value.get<std::string>());
  EXPECT_EQ(ours.texts().size(), theirs["texts"]);
  EXPECT_EQ(ours.damage().dropouts, theirs["dropouts"]);
  EXPECT_TRUE(ours.complaints().empty());
}

INSTANTIATE_TEST_SUITE_P(Known, ForeignFlightTest, testing::ValuesIn(test::kKnownFlights),
                         [](const auto& flight) { return std::string(flight.param.file); });

}  // namespace
}  // namespace ironbird::scenarios
