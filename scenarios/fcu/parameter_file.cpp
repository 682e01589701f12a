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
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/config/text_file.hpp"
#include "scenarios/config/write_file.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::kIntegerParameter;
using hil_bridge::kRealParameter;
using hil_bridge::ParameterRecord;

constexpr std::size_t kLongestName = 16;

const std::vector<std::string> kKeys = {"name", "type", "value"};
constexpr const char* kEntry = "an entry is {name: NAME, type: 6 or 9, value: VALUE}";

/// `line:column`, counted from 1. What is about nothing, as in an empty file, is about its beginning.
std::string place_of(const YAML::Mark& mark) {
  return std::to_string(std::max(mark.line, 0) + 1) + ":" + std::to_string(std::max(mark.column, 0) + 1);
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

/// Collects what is wrong with a file, each with its place.
class Findings {
 public:
  explicit Findings(std::string file) : file_(std::move(file)) {}
  void add(const YAML::Mark& mark, const std::string& text) {
    findings_.push_back(file_ + ":" + place_of(mark) + ": " + text);
  }
  std::size_t count() const { return findings_.size(); }
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
  findings.add(entry.Mark(), std::string("there is no `") + key + "`; " + kEntry);
  return std::nullopt;
}

/// Keys that an entry does not have, and those that come twice: the reader would go past them in silence.
void check_keys(const YAML::Node& entry, Findings& findings) {
  std::set<std::string> seen;
  for (const auto& pair : entry) {
    const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "";
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      const std::string nearest = nearest_name(key, kKeys);
      findings.add(pair.first.Mark(), "`" + key + "` is no key of an entry; " +
                                          (nearest.empty() ? kEntry : "did you mean `" + nearest + "`?"));
    } else if (!seen.insert(key).second) {
      findings.add(pair.first.Mark(), "`" + key + "` comes twice in this entry");
    }
  }
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

std::optional<ParameterRecord> record_of(const YAML::Node& entry, const ParameterJudge& judge,
                                         Findings& findings) {
  if (!entry.IsMap()) {
    findings.add(entry.Mark(), std::string("is no entry; ") + kEntry);
    return std::nullopt;
  }
  const std::size_t before = findings.count();
  check_keys(entry, findings);
  // A key that is misspelt is not missing besides.
  if (findings.count() > before) return std::nullopt;
  const auto name = text_at(entry, "name", findings);
  const auto type = text_at(entry, "type", findings);
  const auto value = text_at(entry, "value", findings);
  if (!name || !type || !value) return std::nullopt;
  const auto kind = type_of(*type);
  if (!is_name(*name)) {
    findings.add(entry["name"].Mark(),
                 "name = \"" + *name + "\", must have 1 to 16 letters, digits and underscores");
    return std::nullopt;
  }
  if (!kind) {
    findings.add(entry["type"].Mark(),
                 *name + ": type = " + *type + ", must be 6 (whole number) or 9 (real number)");
    return std::nullopt;
  }
  const auto bits = hil_bridge::value_bits(*kind, plain(*value));
  const ParameterRecord record{*name, *kind, bits.value_or(0)};
  const std::string complaint =
      bits ? (judge ? judge(record) : "") : std::string(hil_bridge::demand_on_value(*kind));
  if (complaint.empty()) return record;
  findings.add(entry["value"].Mark(), *name + " = " + *value + ", " + complaint);
  return std::nullopt;
}

/// Refuses aliases, by which a file of some megabytes stands for as many copies of a long text, and a second
/// document, which would not be read.
class PlainFile : public YAML::EventHandler {
 public:
  explicit PlainFile(std::string file) : file_(std::move(file)) {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    throw ConfigError(file_ + ":" + place_of(mark) + ": is an alias, `*name`; write what it stands for");
  }
  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 1) return;
    throw ConfigError(file_ + ":" + place_of(mark) +
                      ": a second document begins; a parameter file is one list");
  }
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
  int documents_ = 0;
};

YAML::Node parsed(const std::filesystem::path& file) {
  const std::string text = read_config_text(file, "");
  try {
    PlainFile plain_file(file.string());
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(plain_file)) {
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file.string() + ":" + place_of(error.mark) + ": is not YAML: " + error.msg);
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

std::vector<ParameterRecord> read_parameter_file(const std::filesystem::path& file,
                                                 const ParameterJudge& judge) {
  const YAML::Node root = parsed(file);
  Findings findings(file.string());
  std::vector<ParameterRecord> records;
  std::set<std::string> names;
  if (!root.IsSequence()) {
    findings.add(root.Mark(),
                 "is no list of parameters; each line is - {name: NAME, type: 6 or 9, value: VALUE}");
  } else {
    for (const YAML::Node& entry : root) {
      const auto record = record_of(entry, judge, findings);
      if (!record) continue;
      if (!names.insert(record->name).second)
        findings.add(entry["name"].Mark(), record->name + ": comes twice");
      records.push_back(*record);
    }
  }
  findings.raise();
  return records;
}

}  // namespace ironbird::scenarios
