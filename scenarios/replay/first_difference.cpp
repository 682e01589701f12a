#include "scenarios/replay/first_difference.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>

#include "scenarios/record/topic_columns.hpp"

namespace ironbird::scenarios {

namespace {

/// The shortest text that is this number and no other.
std::string exactly(double value) {
  if (std::isnan(value)) return "no number";
  std::array<char, 40> text;
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), written.ptr};
}

/// All messages that this sees are as large as those of one flight's tick.
constexpr std::uint64_t kEnough = std::uint64_t{1} << 20U;

}  // namespace

FieldDifference difference_of(const std::vector<Ros2MessageType>& types, std::span<const std::uint8_t> was,
                              std::span<const std::uint8_t> is) {
  Allowance allowance(kEnough);
  TopicColumns columns(types, allowance);
  columns.add(was);
  columns.add(is);
  std::vector<std::string> fields;
  std::map<std::string, std::vector<double>, std::less<>> numbers;
  std::map<std::string, std::vector<std::string>, std::less<>> texts;
  columns.finish(fields, numbers, texts);
  for (const std::string& field : fields) {
    const std::vector<double>& pair = numbers.at(field);
    if (std::bit_cast<std::uint64_t>(pair[0]) == std::bit_cast<std::uint64_t>(pair[1])) continue;
    return {field, exactly(pair[0]), exactly(pair[1])};
  }
  for (const auto& [field, pair] : texts) {
    if (pair[0] != pair[1]) return {field, '"' + pair[0] + '"', '"' + pair[1] + '"'};
  }
  return {};
}

}  // namespace ironbird::scenarios
