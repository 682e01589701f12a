// Any text as TOML, and any text as a setting on the command line: refused in single lines that name a place,
// or read; and a table that was read and is printed reads the same.

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <string_view>

#include "ci/fuzzing/harness.hpp"
#include "scenarios/config/toml_reader.hpp"

namespace ironbird::fuzzing {

namespace {

using scenarios::ConfigError;

enum class Colour : std::uint8_t { kRed, kGreen };
constexpr std::array<std::pair<Colour, std::string_view>, 2> enumerators(Colour) {
  return {{{Colour::kRed, "red"}, {Colour::kGreen, "green"}}};
}

struct Part {
  double mass = 1.0;
  std::int32_t count = 3;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("mass", self.mass, "kg", "of the part", 0.0, 100.0);
    visit("count", self.count, "1", "of them", 0, 10);
  }
};

/// One member of every kind that a configuration can have.
struct Everything {
  bool flag = false;
  double angle = 0.0;
  std::uint64_t seed = 0;
  std::int8_t small = 0;
  std::string text;
  Colour colour = Colour::kRed;
  std::chrono::nanoseconds time{};
  Eigen::Matrix<double, 3, 1> vector = Eigen::Matrix<double, 3, 1>::Zero();
  Eigen::Matrix<double, 2, 2> matrix = Eigen::Matrix<double, 2, 2>::Zero();
  Eigen::Quaternion<double> turn = Eigen::Quaternion<double>::Identity();
  std::array<double, 4> several{};
  std::vector<Part> parts;
  std::optional<double> perhaps;
  Part part;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("flag", self.flag, "1", "yes or no");
    visit("angle", self.angle, "rad", "of something", -7.0, 7.0);
    visit("seed", self.seed, "1", "any");
    visit("small", self.small, "1", "a little", -100, 100);
    visit("text", self.text, "", "any");
    visit("colour", self.colour, "1", "one of two");
    visit("time", self.time, "ns", "from the start", 0, 1e12);
    visit("vector", self.vector, "m", "somewhere", -1e3, 1e3);
    visit("matrix", self.matrix, "1", "any");
    visit("turn", self.turn, "1", "attitude");
    visit("several", self.several, "s", "up to four", 0.0, 10.0);
    visit("parts", self.parts, "", "any number");
    visit("perhaps", self.perhaps, "m", "or not", 0.0, 1.0);
    visit("part", self.part, "", "the one");
  }
};

void expect_within_bounds(const Everything& read) {
  const auto within = [](double value, double lower, double upper) {
    return value >= lower && value <= upper;
  };
  require(within(read.angle, -7.0, 7.0) && within(read.part.mass, 0.0, 100.0),
          "a number that was read is within its bounds");
  require(read.small >= -100 && read.small <= 100 && read.part.count >= 0 && read.part.count <= 10,
          "a whole number that was read is within its bounds");
  require(read.time.count() >= 0 && read.time <= std::chrono::seconds(1000),
          "a time that was read is within its bounds");
  require(std::abs(read.turn.norm() - 1.0) < 1e-9, "an attitude that was read has length 1");
  for (const Part& part : read.parts)
    require(within(part.mass, 0.0, 100.0), "a part that was read is within its bounds");
  require(!read.perhaps || within(*read.perhaps, 0.0, 1.0), "what may be missing is within its bounds");
}

void expect_lines(const ConfigError& error) {
  require(!error.findings().empty(), "who refuses says why");
  for (const std::string& finding : error.findings()) {
    require(!finding.empty() && finding.find('\n') == std::string::npos, "a finding is one line: " + finding);
  }
}

/// `path=text`, as behind `--set`.
void set(toml::table& table, std::string_view setting) {
  const std::size_t equals = std::min(setting.find('='), setting.size());
  const std::string_view text = equals < setting.size() ? setting.substr(equals + 1) : std::string_view();
  try {
    scenarios::set_value(table, setting.substr(0, equals), text);
  } catch (const ConfigError& error) {
    expect_lines(error);
  }
}

}  // namespace

/// The first line is a setting, the rest a file.
void check(std::span<const std::uint8_t> input) {
  const std::string_view all(reinterpret_cast<const char*>(input.data()), input.size());
  const std::size_t end = std::min(all.find('\n'), all.size());
  try {
    toml::table table = scenarios::parse_toml(all.substr(std::min(end + 1, all.size())), "file.toml");
    const std::string once = scenarios::print_toml(table);
    require(scenarios::print_toml(scenarios::parse_toml(once, "again.toml")) == once,
            "what was read and is printed reads the same");
    set(table, all.substr(0, end));
    Everything everything;
    scenarios::read_toml(table, everything);
    expect_within_bounds(everything);
  } catch (const ConfigError& error) {
    expect_lines(error);
  }
}

}  // namespace ironbird::fuzzing
