#include "scenarios/config/toml_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <sstream>

#include "scenarios/config/degrees.hpp"
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/config/quantity.hpp"
#include "scenarios/config/shortest.hpp"

namespace ironbird::scenarios {
namespace {

/// How far a quaternion's norm may be from one: what six written digits leave.
constexpr double kUnitNorm = 1e-5;

/// A real number as a file has it: the library that prints nodes writes -3.9 as -3.8999999999999999.
std::string written(double value) {
  const std::string text = shortest(value);
  const bool looks_whole = text.find_first_not_of("-0123456789") == std::string::npos;
  return looks_whole ? text + ".0" : text;
}

/// The node on one line.
std::string inlined(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return written(number->get());
  std::ostringstream stream;
  if (const toml::table* table = node.as_table()) {
    const char* between = " ";
    for (const auto& [key, value] : *table) {
      stream << between << key.str() << " = " << inlined(value);
      between = ", ";
    }
    return table->empty() ? "{}" : "{" + stream.str() + " }";
  }
  if (const toml::array* array = node.as_array()) {
    const char* between = " ";
    for (const toml::node& element : *array) {
      stream << between << inlined(element);
      between = ", ";
    }
    return array->empty() ? "[]" : "[" + stream.str() + " ]";
  }
  node.visit([&](const auto& value) { stream << value; });
  return stream.str();
}

/// The node as it stands in the file, cut when long.
std::string shown(const toml::node& node) {
  constexpr std::size_t kMost = 60;
  std::string text = inlined(node);
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() <= kMost) return text;
  std::size_t cut = kMost;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0) == 0x80) --cut;  // not inside a character
  return text.substr(0, cut) + "...";
}

std::string with_unit(const std::string& text, std::string_view unit) {
  return unit.empty() || unit == "1" || unit == "SI" ? text : text + " " + std::string(unit);
}

/// The bounds of an angle again, as people know them.
std::string in_degrees(const Allowed& allowed) {
  if (allowed.unit != "rad") return "";
  const auto degrees = [](double angle) {
    return shortest(std::round(angle * kDegreesPerRadian * 1e6) / 1e6);
  };
  return " (" + degrees(allowed.lower) + " and " + degrees(allowed.upper) + " deg)";
}

/// What a whole number in a file can be at most: exactly, and as a bound that is a double.
const std::string kGreatestInteger = std::to_string(std::numeric_limits<std::int64_t>::max());
constexpr double kFileHolds = 9.2e18;

/// An option's whole number that is too great for TOML arrives as a text.
bool is_great(const toml::node& node) {
  const auto text = node.value<std::string>();
  return text && text->size() >= kGreatestInteger.size() &&
         text->find_first_not_of("0123456789") == std::string::npos;
}

/// What is wrong with a number, or nothing.
std::string complaint(double value, const Allowed& allowed) {
  if (!std::isfinite(value)) return "must be finite";
  if (value >= allowed.lower && value <= allowed.upper) return "";
  if (allowed.upper == kUnbounded) return with_unit("must be >= " + shortest(allowed.lower), allowed.unit);
  if (allowed.lower == -kUnbounded) return with_unit("must be <= " + shortest(allowed.upper), allowed.unit);
  return with_unit("must be between " + shortest(allowed.lower) + " and " + shortest(allowed.upper),
                   allowed.unit) +
         in_degrees(allowed);
}

/// `[a.b]` for a table, `[[a.b]]` for an element of an array of tables; nothing inside such an element, which
/// has no header of its own that could be shown.
std::string header_of(const std::string& path) {
  const std::size_t bracket = path.find('[');
  if (bracket == std::string::npos) return ", written [" + path + "]";
  return path.find_first_of("[.", bracket + 1) == std::string::npos && path.back() == ']'
             ? ", written [[" + path.substr(0, bracket) + "]]"
             : ", written { key = value }";
}

}  // namespace

void TomlReader::finish() const {
  if (!findings_.empty()) throw ConfigError(findings_);
}

void TomlReader::report(const toml::node& node, const std::string& path, const std::string& what) {
  findings_.push_back(place_of(node) + ": " + path + " = " + shown(node) + ": " + what);
}

void TomlReader::report_no_table(const toml::node& node, const std::string& path) {
  report(node, path, "must be a table" + header_of(path));
}

void TomlReader::report_no_tables(const toml::node& node, const std::string& path) {
  const std::string header = "[[" + path + "]]";
  report(node, path,
         node.is_table() ? "must be an array of tables: write " + header + " instead of [" + path + "]"
                         : "must be an array of tables, each written " + header);
}

bool TomlReader::has_unknown(const toml::table& table, const std::vector<std::string>& known) {
  return std::any_of(table.begin(), table.end(), [&](const auto& entry) {
    return std::find(known.begin(), known.end(), entry.first.str()) == known.end();
  });
}

std::string TomlReader::meant(std::string_view key, const Keys& keys) {
  const auto inner_name = [](const std::string& full) { return full.substr(full.find('.') + 1); };
  // A member's own member, given a table too high, is spelt right; a near name is a guess.
  std::vector<std::string> inner_names;
  for (const std::string& full : keys.inner) {
    if (inner_name(full) == key) return full;
    inner_names.push_back(inner_name(full));
  }
  std::string nearest = nearest_name(key, keys.known);
  if (!nearest.empty()) return nearest;
  nearest = nearest_name(key, inner_names);
  const auto found = std::find(inner_names.begin(), inner_names.end(), nearest);
  return nearest.empty() ? "" : keys.inner[static_cast<std::size_t>(found - inner_names.begin())];
}

void TomlReader::report_unknown(const toml::table& table, const std::string& path, const Keys& keys) {
  const std::vector<std::string>& known = keys.known;
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    std::string what = "unknown key";
    const std::string nearest = meant(key.str(), keys);
    if (!nearest.empty()) {
      what += ", did you mean '" + nearest + "'?";
    } else {
      what += ", known are: ";
      for (const std::string& name : known) what += (&name == &known.front() ? "" : ", ") + name;
    }
    const std::string full = (path.empty() ? "" : path + ".") + std::string(key.str());
    const std::string place = key.source().path ? location(key.source()) : place_of(node);
    findings_.push_back(place + ": " + full + " = " + shown(node) + ": " + what);
  }
}

void TomlReader::read_bool(const toml::node& node, bool& value, const std::string& path) {
  if (!node.is_boolean()) return report(node, path, "must be true or false");
  value = node.as_boolean()->get();
}

void TomlReader::read_text(const toml::node& node, std::string& value, const std::string& path) {
  if (!node.is_string()) return report(node, path, "must be a text in quotes");
  const std::string& text = node.as_string()->get();
  const auto controls = [](unsigned char c) { return c < ' ' || c == 0x7F; };
  if (std::any_of(text.begin(), text.end(), controls))
    return report(node, path, "has a control character; must be text of one line");
  value = text;
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
    const bool plain = allowed.unit.empty() || allowed.unit == "1";
    return report(node, path,
                  plain ? "must be a number" : "must be a number, in " + std::string(allowed.unit));
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
    report(node, path, "must be a whole number" + (is_great(node) ? " of at most " + kGreatestInteger : ""));
    return std::nullopt;
  }
  const double lower = std::max(least, allowed.lower);
  const double upper = std::min(greatest, allowed.upper);
  std::string wrong = complaint(number, {allowed.unit, lower, upper});
  if (!wrong.empty() && upper > kFileHolds)
    wrong = "must be between " + shortest(lower) + " and " + kGreatestInteger;
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
