#include "scenarios/config/quantity.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <sstream>
#include <string>

namespace ironbird::scenarios {
namespace {

constexpr double kPi = std::numbers::pi;

struct QuantityCase {
  const char* text;
  const char* needed;
  double value;
};
class QuantityTest : public ::testing::TestWithParam<QuantityCase> {};

TEST_P(QuantityTest, IsConvertedToTheNeededUnit) {
  EXPECT_DOUBLE_EQ(parse_quantity(GetParam().text, GetParam().needed), GetParam().value)
      << GetParam().text << " as " << GetParam().needed;
}

INSTANTIATE_TEST_SUITE_P(
    Quantities, QuantityTest,
    ::testing::Values(
        QuantityCase{"25 deg", "rad", 25.0 * kPi / 180.0}, QuantityCase{"25deg", "rad", 25.0 * kPi / 180.0},
        QuantityCase{"  -3 m/s ", "m/s", -3.0}, QuantityCase{"+3 m/s", "m/s", 3.0},
        QuantityCase{"72 km/h", "m/s", 20.0}, QuantityCase{"1.1 kg", "kg", 1.1},
        QuantityCase{"250 g", "kg", 0.25}, QuantityCase{"5", "m", 5.0}, QuantityCase{"1e-3", "1", 1e-3},
        QuantityCase{"40 %", "1", 0.4}, QuantityCase{"0.5 ms", "s", 0.0005},
        QuantityCase{"0.5 ms", "ns", 500000.0}, QuantityCase{"90 s", "ns", 90e9},
        QuantityCase{"2 min", "s", 120.0}, QuantityCase{"1 h", "s", 3600.0},
        QuantityCase{"400 Hz", "s", 0.0025}, QuantityCase{"400 Hz", "ns", 2500000.0},
        QuantityCase{"2 kHz", "s", 0.0005}, QuantityCase{"50 ms", "Hz", 20.0},
        QuantityCase{"50 ms", "1/s", 20.0}, QuantityCase{"20 Hz", "1/s", 20.0},
        QuantityCase{"60 rpm", "rad/s", 2.0 * kPi}, QuantityCase{"180 deg/s", "rad/s", kPi},
        QuantityCase{"1013.25 hPa", "Pa", 101325.0}, QuantityCase{"1 bar", "Pa", 1e5},
        QuantityCase{"10 mbar", "Pa", 1000.0}, QuantityCase{"50 uT", "T", 50e-6},
        QuantityCase{"0.5 gauss", "T", 50e-6}, QuantityCase{"5000 mAh", "A*s", 18000.0},
        QuantityCase{"15 degC", "K", 288.15}, QuantityCase{"12 mm", "m", 0.012},
        QuantityCase{"30 cm", "m", 0.3}, QuantityCase{"2 kg*m^2", "kg*m^2", 2.0},
        QuantityCase{"20000 g*cm^2", "kg*m^2", 0.002}, QuantityCase{"3 N", "kg*m/s^2", 3.0},
        QuantityCase{"2 J", "N*m", 2.0}, QuantityCase{"9 V", "W/A", 9.0},
        QuantityCase{"1.2 kg/m^3", "kg/m^3", 1.2}, QuantityCase{"1 N*s^2/rad^2", "N*s^2/rad^2", 1.0},
        QuantityCase{"1 N/(rad/s)^2", "N*s^2/rad^2", 1.0}, QuantityCase{"4 rad/s/sqrt(Hz)", "rad/s^0.5", 4.0},
        QuantityCase{"180 deg/sqrt(h)", "rad/sqrt(s)", kPi / 60.0}, QuantityCase{"7 m*s^-2", "m/s^2", 7.0},
        QuantityCase{"36 km/h", "", 10.0}, QuantityCase{"90 deg", "", kPi / 2.0}),
    [](const auto& test) { return "Case" + std::to_string(test.index); });

struct WrongCase {
  const char* text;
  const char* needed;
  const char* message;
};
class WrongQuantityTest : public ::testing::TestWithParam<WrongCase> {};

TEST_P(WrongQuantityTest, IsRefusedWithWhatIsNeeded) {
  try {
    parse_quantity(GetParam().text, GetParam().needed);
    FAIL() << GetParam().text;
  } catch (const QuantityError& error) {
    EXPECT_STREQ(error.what(), GetParam().message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Quantities, WrongQuantityTest,
    ::testing::Values(
        WrongCase{"25 deg", "m/s", "found 'deg', needs m/s or km/h"},
        WrongCase{"5 m", "1", "found 'm', needs a number without unit, or %"},
        WrongCase{"5 Hz", "rad/s", "found 'Hz', needs rad/s, deg/s or rpm"},
        WrongCase{"5 m", "rad", "found 'm', needs rad, deg or rev"},
        WrongCase{"5 m", "rad/s^2", "found 'm', needs rad/s^2 or deg/s^2"},
        WrongCase{"5 m", "s", "found 'm', needs s, ms, us, min, h or Hz (its rate)"},
        WrongCase{"5 m", "Hz", "found 'm', needs Hz, kHz or s (its period)"},
        WrongCase{"5 m", "N*m", "found 'm', needs N*m"},
        WrongCase{"north", "rad", "found 'north', needs a number of rad, deg or rev"},
        WrongCase{"5 1/m", "m", "found '1/m', needs m, mm, cm or km"},
        WrongCase{"fast", "m/s", "found 'fast', needs a number of m/s or km/h"},
        WrongCase{"", "1", "found '', needs a number"},
        WrongCase{"+-5 m", "m", "found '+-5 m', needs a number of m, mm, cm or km"},
        WrongCase{"0 Hz", "s", "found '0 Hz', which has no reciprocal"},
        WrongCase{"5 parsec", "m", "found 'parsec' ('parsec' is no unit), needs m, mm, cm or km"},
        WrongCase{"5 m^x", "m", "found 'm^x' ('x' is no power), needs m, mm, cm or km"},
        WrongCase{"5 m^0.3", "m", "found 'm^0.3' ('0.3' is no power), needs m, mm, cm or km"},
        WrongCase{"5 m/(s", "m", "found 'm/(s' (')' is missing), needs m, mm, cm or km"},
        WrongCase{"5 m)", "m", "found 'm)' (')' is left over), needs m, mm, cm or km"},
        WrongCase{"5 m/", "m", "found 'm/' ('' is no unit), needs m, mm, cm or km"},
        WrongCase{"5 ((((((((((m", "m", "found '((((((((((m' (too many parentheses), needs m, mm, cm or km"}),
    [](const auto& test) { return "Case" + std::to_string(test.index); });

TEST(QuantityConversionTest, IsExactWhereADecimalIs) {
  // A factor of 0.001 would miss these by one bit.
  EXPECT_EQ(parse_quantity("9 ms", "s"), 0.009);
  EXPECT_EQ(parse_quantity("2.3 ms", "s"), 0.0023);
  EXPECT_EQ(parse_quantity("400 Hz", "s"), 0.0025);
  EXPECT_EQ(parse_quantity("1013.25 hPa", "Pa"), 101325.0);
}

TEST(QuantityConversionTest, TakesEveryUnitThatARefusalOffers) {
  for (const char* needed : {"m",     "m/s",     "kg", "s",  "Hz", "1/s", "A", "C",   "A*s", "K", "rad",
                             "rad/s", "rad/s^2", "N",  "Pa", "J",  "W",   "V", "Ohm", "F",   "H", "T"}) {
    std::string said;
    try {
      parse_quantity("1 kg^3", needed);
    } catch (const QuantityError& error) {
      said = error.what();
    }
    std::istringstream words(said.substr(said.find("needs ") + 6));
    int offered = 0;
    for (std::string word; words >> word;) {
      if (word == "or" || word.starts_with("(") || word.ends_with(")")) continue;
      if (word.ends_with(",")) word.pop_back();
      EXPECT_NO_THROW(parse_quantity("1 " + word, needed)) << said;
      ++offered;
    }
    EXPECT_GT(offered, 0) << needed;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
