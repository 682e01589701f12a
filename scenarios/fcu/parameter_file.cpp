#include "scenarios/fcu/parameter_file.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "scenarios/config/config_error.hpp"
#include "scenarios/config/text_file.hpp"
#include "scenarios/config/write_file.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::kIntegerParameter;
using hil_bridge::kRealParameter;
using hil_bridge::ParameterRecord;

constexpr std::size_t kLongestName = 16;

/// Counted from 1. What is about nothing, as in an empty file, is about its beginning.
std::string line_of(const YAML::Mark& mark) {
  return std::to_string(std::max(mark.line, 0) + 1);
}

/// Letters, digits and underscores: what a unit's names are made of, and what stands in a file without
/// quotes.
bool is_name(std::string_view text) {
  const auto usual = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.size() <= kLongestName && std::all_of(text.begin(), text.end(), usual);
}

/// In quotes when it is not usual, or when YAML would take it for nothing at all.
std::string written_name(const std::string& name) {
  if (is_name(name) && name != "null" && name != "Null" && name != "NULL") return name;
  std::string text = "\"";
  for (const char c : name) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code >= 0x7F || c == '"' || c == '\\') {
      text += {'\\', 'x', kDigits[code >> 4U], kDigits[code & 15U]};
    } else {
      text += c;
    }
  }
  return text + '"';
}

/// Collects what is wrong with a file, each with its line.
class Findings {
 public:
  explicit Findings(std::string file) : file_(std::move(file)) {}
  void add(const YAML::Mark& mark, const std::string& text) {
    findings_.push_back(file_ + ":" + line_of(mark) + ": " + text);
  }
  void raise() const {
    if (!findings_.empty()) throw ConfigError(findings_);
  }

 private:
  std::string file_;
  std::vector<std::string> findings_;
};

/// The text of one key of an entry, or none, which is a finding.
std::optional<std::string> text_at(const YAML::Node& entry, const char* key, Findings& findings) {
  const YAML::Node node = entry[key];
  if (node && node.IsScalar()) return node.Scalar();
  findings.add(entry.Mark(), std::string("there is no `") + key +
                                 "`; an entry is {name: NAME, type: 6 or 9, value: VALUE}");
  return std::nullopt;
}

std::optional<std::uint8_t> type_of(const std::string& text) {
  if (text == "6") return kIntegerParameter;
  if (text == "9") return kRealParameter;
  return std::nullopt;
}

/// Numbers as YAML writes them, in the way that parameters are read.
std::string plain(const std::string& value) {
  if (value == ".nan" || value == ".NaN") return "nan(0x7fc00000)";
  if (value == ".inf" || value == "-.inf") return value.front() == '-' ? "-inf" : "inf";
  return value.starts_with('+') ? value.substr(1) : value;
}

std::optional<ParameterRecord> record_of(const YAML::Node& entry, Findings& findings) {
  if (!entry.IsMap()) {
    findings.add(entry.Mark(), "is no entry; an entry is {name: NAME, type: 6 or 9, value: VALUE}");
    return std::nullopt;
  }
  const auto name = text_at(entry, "name", findings);
  const auto type = text_at(entry, "type", findings);
  const auto value = text_at(entry, "value", findings);
  if (!name || !type || !value) return std::nullopt;
  const auto kind = type_of(*type);
  if (!is_name(*name)) {
    findings.add(entry.Mark(), "name = \"" + *name + "\", must have 1 to 16 letters, digits and underscores");
  } else if (!kind) {
    findings.add(entry.Mark(), *name + ": type = " + *type + ", must be 6 (whole number) or 9 (real number)");
  } else if (const auto bits = hil_bridge::value_bits(*kind, plain(*value)); !bits) {
    findings.add(entry.Mark(),
                 *name + " = " + *value + ", must be " +
                     (*kind == kIntegerParameter ? "a whole number of 32 bits" : "a real number"));
  } else {
    return ParameterRecord{*name, *kind, *bits};
  }
  return std::nullopt;
}

/// Refuses aliases: by them a file of some megabytes stands for as many copies of a long text.
class NoAliases : public YAML::EventHandler {
 public:
  explicit NoAliases(std::string file) : file_(std::move(file)) {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    throw ConfigError(file_ + ":" + line_of(mark) + ": is an alias, `*name`; write what it stands for");
  }
  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}

 private:
  std::string file_;
};

YAML::Node parsed(const std::filesystem::path& file) {
  const std::string text = read_config_text(file, "");
  try {
    NoAliases no_aliases(file.string());
    std::istringstream stream(text);
    YAML::Parser(stream).HandleNextDocument(no_aliases);
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file.string() + ":" + line_of(error.mark) + ": is not YAML: " + error.msg);
  }
}

}  // namespace

std::string parameter_file_text(const std::vector<ParameterRecord>& records) {
  if (records.empty()) return "[]\n";  // nothing at all would be no list
  std::string text;
  for (const ParameterRecord& record : records) {
    text += "- {name: " + written_name(record.name) + ", type: " + std::to_string(record.type) +
            ", value: " + hil_bridge::value_text(record) + "}\n";
  }
  return text;
}

void write_parameter_file(const std::filesystem::path& file, const std::vector<ParameterRecord>& records) {
  write_file(file, parameter_file_text(records));
}

std::vector<ParameterRecord> read_parameter_file(const std::filesystem::path& file) {
  const YAML::Node root = parsed(file);
  Findings findings(file.string());
  std::vector<ParameterRecord> records;
  std::set<std::string> names;
  if (!root.IsSequence()) {
    findings.add(root.Mark(),
                 "is no list of parameters; each line is - {name: NAME, type: 6 or 9, value: VALUE}");
  } else {
    for (const YAML::Node& entry : root) {
      const auto record = record_of(entry, findings);
      if (!record) continue;
      if (!names.insert(record->name).second) findings.add(entry.Mark(), record->name + ": comes twice");
      records.push_back(*record);
    }
  }
  findings.raise();
  return records;
}

}  // namespace ironbird::scenarios
