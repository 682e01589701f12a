#include "scenarios/config/toml_reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "scenarios/config/nearest_name.hpp"
#include "scenarios/config/quantity.hpp"

namespace ironbird::scenarios {
namespace {

/// How far a quaternion's norm may be from one: what six written digits leave.
constexpr double kUnitNorm = 1e-5;

std::string shortest(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

/// The node as it stands in the file, cut when long.
std::string shown(const toml::node& node) {
  constexpr std::size_t kMost = 60;
  std::ostringstream stream;
  node.visit([&](const auto& value) { stream << value; });
  std::string text = stream.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

std::string with_unit(const std::string& text, std::string_view unit) {
  return unit.empty() || unit == "1" || unit == "SI" ? text : text + " " + std::string(unit);
}

/// What is wrong with a number, or nothing.
std::string complaint(double value, const Allowed& allowed) {
  if (!std::isfinite(value)) return "must be finite";
  if (value >= allowed.lower && value <= allowed.upper) return "";
  if (allowed.upper == kUnbounded) return with_unit("must be >= " + shortest(allowed.lower), allowed.unit);
  if (allowed.lower == -kUnbounded) return with_unit("must be <= " + shortest(allowed.upper), allowed.unit);
  return with_unit("must be between " + shortest(allowed.lower) + " and " + shortest(allowed.upper),
                   allowed.unit);
}

}  // namespace

void TomlReader::finish() const {
  if (!findings_.empty()) throw ConfigError(findings_);
}

void TomlReader::report(const toml::node& node, const std::string& path, const std::string& what) {
  findings_.push_back(location(node.source()) + ": " + path + " = " + shown(node) + ": " + what);
}

void TomlReader::report_unknown(const toml::table& table, const std::string& path,
                                const std::vector<std::string>& known) {
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    std::string what = "unknown key";
    const std::string nearest = nearest_name(key.str(), known);
    if (!nearest.empty()) {
      what += ", did you mean '" + nearest + "'?";
    } else {
      what += ", known are: ";
      for (const std::string& name : known) what += (&name == &known.front() ? "" : ", ") + name;
    }
    const std::string full = (path.empty() ? "" : path + ".") + std::string(key.str());
    const toml::source_region& source = key.source().path ? key.source() : node.source();
    findings_.push_back(location(source) + ": " + full + " = " + shown(node) + ": " + what);
  }
}

void TomlReader::read_bool(const toml::node& node, bool& value, const std::string& path) {
  if (!node.is_boolean()) return report(node, path, "must be true or false");
  value = node.as_boolean()->get();
}

void TomlReader::read_text(const toml::node& node, std::string& value, const std::string& path) {
  if (!node.is_string()) return report(node, path, "must be a text in quotes");
  value = node.as_string()->get();
}

void TomlReader::read_number(const toml::node& node, double& value, const Allowed& allowed,
                             const std::string& path) {
  double number = 0.0;
  if (node.is_string()) {
    try {
      number = parse_quantity(node.as_string()->get(), allowed.unit);
    } catch (const QuantityError& error) {
      return report(node, path, error.what());
    }
  } else if (node.is_number()) {
    number = *node.value<double>();
  } else {
    return report(node, path, with_unit("must be a number", allowed.unit));
  }
  const std::string wrong = complaint(number, allowed);
  if (!wrong.empty()) return report(node, path, wrong);
  value = number;
}

void TomlReader::read_time(const toml::node& node, std::chrono::nanoseconds& value, const Allowed& allowed,
                           const std::string& path) {
  constexpr double kPerSecond = 1e9;
  constexpr double kMost = 9.2e9;  // s, what 64 bits of nanoseconds hold
  double time = 0.0;
  const Allowed in_seconds{"s", std::max(allowed.lower / kPerSecond, -kMost),
                           std::min(allowed.upper / kPerSecond, kMost)};
  const std::size_t before = findings_.size();
  read_number(node, time, in_seconds, path);
  if (findings_.size() == before) value = std::chrono::nanoseconds(std::llround(time * kPerSecond));
}

void TomlReader::read_quaternion(const toml::node& node, Eigen::Quaternion<double>& value,
                                 const std::string& path) {
  Eigen::Matrix<double, 4, 1> wxyz;
  const std::size_t before = findings_.size();
  read_matrix(node, wxyz, {"1"}, path);
  if (findings_.size() != before) return;
  if (std::abs(wxyz.norm() - 1.0) > kUnitNorm) return report(node, path, "must be [w, x, y, z] of length 1");
  value = Eigen::Quaternion<double>(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
}

std::optional<std::int64_t> TomlReader::integer(const toml::node& node, const Allowed& allowed,
                                                const std::string& path, double least, double greatest) {
  double number = 0.0;
  if (node.is_integer()) {
    number = static_cast<double>(node.as_integer()->get());
  } else if (node.is_string() && allowed.unit != "1") {
    const std::size_t before = findings_.size();
    read_number(node, number, allowed, path);
    if (findings_.size() != before) return std::nullopt;
  } else {
    report(node, path, "must be a whole number");
    return std::nullopt;
  }
  std::string wrong =
      complaint(number, {allowed.unit, std::max(least, allowed.lower), std::min(greatest, allowed.upper)});
  if (number != std::round(number)) wrong = "must be a whole number";
  if (!wrong.empty()) {
    report(node, path, wrong);
    return std::nullopt;
  }
  return node.is_integer() ? node.as_integer()->get() : static_cast<std::int64_t>(number);
}

const toml::array* TomlReader::elements(const toml::node& node, std::size_t least, std::size_t most,
                                        const std::string& path) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    report(node, path, "must be an array");
    return nullptr;
  }
  if (array->size() >= least && array->size() <= most) return array;
  report(node, path,
         "must have " + (least == most ? "" : std::string("at most ")) + std::to_string(most) +
             " elements, has " + std::to_string(array->size()));
  return nullptr;
}

std::optional<std::string> TomlReader::name(const toml::node& node, const std::string& path,
                                            const std::vector<std::string>& names) {
  const auto text = node.value<std::string>();
  if (text && std::find(names.begin(), names.end(), *text) != names.end()) return text;
  std::string what = "must be one of ";
  for (const std::string& known : names) what += (&known == &names.front() ? "" : ", ") + known;
  const std::string nearest = text ? nearest_name(*text, names) : "";
  if (!nearest.empty()) what += "; did you mean '" + nearest + "'?";
  report(node, path, what);
  return std::nullopt;
}

}  // namespace ironbird::scenarios
