// Any text as a parameter file: it is refused, in single lines that name theirs, or it gives parameters that
// a unit can have; and those, written, are read back the same.

#include <algorithm>
#include <set>

#include "ci/fuzzing/harness.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/fcu/parameter_file.hpp"

namespace ironbird::fuzzing {

namespace {

using hil_bridge::ParameterRecord;
using scenarios::ConfigError;

std::vector<ParameterRecord> read(const MemoryFile& file) {
  return scenarios::read_parameter_file(file.path());
}

/// `file:line:column: what is wrong`
void expect_placed(const std::string& finding, const std::string& file) {
  require(finding.find('\n') == std::string::npos, "a finding is one line: " + finding);
  if (finding.ends_with(" findings more")) return;  // of a file that is wrong throughout
  require(finding.starts_with(file + ":"), "a finding names its file: " + finding);
  std::string_view rest = std::string_view(finding).substr(file.size() + 1);
  for (const char* const end : {":", ": "}) {
    const std::size_t digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
    require(digits > 0 && rest.substr(digits).starts_with(end), "a finding names its place: " + finding);
    rest.remove_prefix(digits + 1);
  }
}

void expect_parameters(const std::vector<ParameterRecord>& records) {
  std::set<std::string> names;
  for (const ParameterRecord& record : records) {
    require(!record.name.empty() && record.name.size() <= 16, "a name has 1 to 16 letters");
    require(names.insert(record.name).second, "a name comes once");
    require(record.type == hil_bridge::kIntegerParameter || record.type == hil_bridge::kRealParameter,
            "a type is one of two");
  }
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  static const MemoryFile file;
  file.write(input);
  std::vector<ParameterRecord> records;
  try {
    records = read(file);
  } catch (const ConfigError& error) {
    require(!error.findings().empty(), "who refuses says why");
    for (const std::string& finding : error.findings()) expect_placed(finding, file.path());
    return;
  }
  expect_parameters(records);
  file.write(scenarios::parameter_file_text(records));
  try {
    require(read(file) == records, "what is written is read back the same");
  } catch (const ConfigError& error) {
    require(false, std::string("what is written can be read: ") + error.what());
  }
}

}  // namespace ironbird::fuzzing
