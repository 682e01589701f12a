#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/make_guard.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/fcu/fcu_verb.hpp"
#include "scenarios/fcu/parameter_bounds.hpp"
#include "scenarios/fcu/parameter_file.hpp"
#include "scenarios/fcu/parameter_push.hpp"
#include "scenarios/fcu/unit_line.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::ParameterDifference;
using hil_bridge::ParameterRecord;

struct ParamsArguments {
  UnitAddress address;
  std::string deed;
  std::vector<std::string> words;
  bool keep = false;
  std::vector<ParameterRecord> file;  // of load, diff, verify
};

bool reads_a_file(const std::string& deed) {
  return deed == "load" || deed == "diff" || deed == "verify";
}

std::string value_of(const std::optional<ParameterRecord>& record) {
  return record ? hil_bridge::value_text(*record) : "(none)";
}

void print(const std::vector<ParameterDifference>& differences, const char* one, const char* other) {
  for (const ParameterDifference& difference : differences) {
    std::printf("%-16s %s %s, %s %s\n", difference.name.c_str(), one, value_of(difference.one).c_str(), other,
                value_of(difference.other).c_str());
  }
  std::fflush(stdout);  // what is said about them comes after them
}

std::string unknown(const std::string& name, UnitOnLine& unit) {
  std::vector<std::string> names;
  for (const ParameterRecord& record : unit.connection().parameters().known()) names.push_back(record.name);
  const std::string nearest = nearest_name(name, names);
  return name + ": the unit has no such parameter" +
         (nearest.empty() ? "" : "; did you mean " + nearest + "?");
}

ParameterRecord record_named(const std::string& name, UnitOnLine& unit) {
  if (const auto record = unit.connection().parameters().find(name)) return *record;
  throw ConfigError(unknown(name, unit));
}

/// Everything of a file that this unit cannot take, told before anything is set.
void check_fits(const std::vector<ParameterRecord>& file, UnitOnLine& unit) {
  std::vector<std::string> findings;
  for (const ParameterRecord& wanted : file) {
    const auto there = unit.connection().parameters().find(wanted.name);
    if (!there) {
      findings.push_back(unknown(wanted.name, unit));
    } else if (there->type != wanted.type) {
      findings.push_back(wanted.name + ": type = " + std::to_string(wanted.type) + ", the unit has type " +
                         std::to_string(there->type));
    }
  }
  if (!findings.empty()) throw ConfigError(findings);
}

/// Says what is set and what is not.
int tell(const PushResult& result, std::size_t wanted) {
  print(result.left, "wanted", result.broken_off.empty() ? "the unit has" : "the unit last said");
  const std::size_t left = result.left.size();
  if (result.broken_off.empty()) {
    std::fprintf(stderr, "%zu of %zu parameters are not as wanted\n", left, wanted);
  } else {
    std::fprintf(stderr,
                 "%s: %zu of %zu parameters are set, %zu are not, or not known to be. Set them again\n",
                 result.broken_off.c_str(), wanted - left, wanted, left);
  }
  return interrupt_requested() ? kExitInterrupted : kExitHardware;
}

int set_and_report(const std::vector<ParameterRecord>& wanted, const ParamsArguments& arguments,
                   UnitOnLine& unit) {
  check_fits(wanted, unit);
  const PushResult result = push_parameters(wanted, unit);
  if (!result.left.empty() || !result.broken_off.empty()) return tell(result, wanted.size());
  std::fprintf(stderr, "as wanted, read back from the unit: %zu parameter%s\n", wanted.size(),
               wanted.size() == 1 ? "" : "s");
  if (arguments.keep) return unit.keep() ? kExitPass : kExitHardware;
  if (unit.connection().parameters().unsaved()) {
    std::fputs("not kept over a restart; --keep writes them to the unit's flash\n", stderr);
  }
  return kExitPass;
}

int get(const ParamsArguments& arguments, UnitOnLine& unit) {
  std::vector<ParameterRecord> records;
  for (const std::string& name : arguments.words) records.push_back(record_named(name, unit));
  if (arguments.words.empty()) records = unit.connection().parameters().known();
  for (const ParameterRecord& record : records) {
    std::printf("%-16s %s\n", record.name.c_str(), hil_bridge::value_text(record).c_str());
  }
  return kExitPass;
}

int set(const ParamsArguments& arguments, UnitOnLine& unit) {
  std::vector<ParameterRecord> wanted;
  std::vector<std::string> findings;
  for (std::size_t k = 0; k + 1 < arguments.words.size(); k += 2) {
    ParameterRecord record = record_named(arguments.words[k], unit);
    const auto bits = hil_bridge::value_bits(record.type, arguments.words[k + 1]);
    record.bits = bits.value_or(0);
    const std::string complaint =
        bits ? complaint_about_value(record) : std::string(hil_bridge::demand_on_value(record.type));
    if (!complaint.empty())
      findings.push_back(record.name + " = " + arguments.words[k + 1] + ", " + complaint);
    const auto same = [&](const ParameterRecord& other) { return other.name == record.name; };
    if (std::any_of(wanted.begin(), wanted.end(), same)) findings.push_back(record.name + ": comes twice");
    wanted.push_back(record);
  }
  if (!findings.empty()) throw ConfigError(findings);
  return set_and_report(wanted, arguments, unit);
}

int compare(const ParamsArguments& arguments, UnitOnLine& unit, bool all) {
  const auto& file = arguments.file;
  const auto found = all ? hil_bridge::differences(file, unit.connection().parameters().known())
                         : hil_bridge::not_as_wanted(file, unit.connection().parameters().known());
  print(found, "file", "unit");
  std::fprintf(stderr, "%zu difference%s\n", found.size(), found.size() == 1 ? "" : "s");
  return found.empty() ? kExitPass : kExitFail;
}

int save(const ParamsArguments& arguments, UnitOnLine& unit) {
  write_parameter_file(arguments.words[0], unit.connection().parameters().known());
  std::fprintf(stderr, "%s: %d parameters\n", arguments.words[0].c_str(),
               unit.connection().parameters().progress().known);
  return kExitPass;
}

/// One thing to do with parameters, and how many words it needs.
struct Deed {
  const char* name;
  const char* words;
  bool (*fits)(std::size_t);
  int (*work)(const ParamsArguments&, UnitOnLine&);
};

const Deed kDeeds[] = {
    {"get", "[NAME...]", [](std::size_t) { return true; }, get},
    {"set", "NAME VALUE [NAME VALUE...]", [](std::size_t n) { return n >= 2 && n % 2 == 0; }, set},
    {"save", "FILE", [](std::size_t n) { return n == 1; }, save},
    {"load", "FILE", [](std::size_t n) { return n == 1; },
     [](const ParamsArguments& arguments, UnitOnLine& unit) {
       return set_and_report(arguments.file, arguments, unit);
     }},
    {"diff", "FILE", [](std::size_t n) { return n == 1; },
     [](const ParamsArguments& arguments, UnitOnLine& unit) { return compare(arguments, unit, true); }},
    {"verify", "FILE", [](std::size_t n) { return n == 1; },
     [](const ParamsArguments& arguments, UnitOnLine& unit) { return compare(arguments, unit, false); }},
};

const Deed& deed_named(const ParamsArguments& arguments) {
  std::string all;
  for (const Deed& deed : kDeeds) {
    all += (all.empty() ? "" : ", ") + std::string(deed.name);
    if (arguments.deed != deed.name) continue;
    if (deed.fits(arguments.words.size())) return deed;
    throw ConfigError(std::string("write: ironbird fcu params ") + deed.name + " " + deed.words);
  }
  throw ConfigError(arguments.deed + ": fcu params does not know this; there are: " + all);
}

int params(ParamsArguments arguments, const autopilot::Modules& modules) {
  note_interrupts();
  const Deed& deed = deed_named(arguments);
  // A file that cannot be read is told before the unit is waited for.
  if (reads_a_file(arguments.deed)) {
    const std::filesystem::path file = arguments.words[0];
    ParameterJudge judge;
    if (arguments.deed == "load") judge = complaint_about_value;
    arguments.file = file.extension() == ".toml"
                         ? wanted_parameters(load_scenario(file, {}, modules).scenario)
                         : read_parameter_file(file, judge);
  }
  UnitOnLine unit(arguments.address);
  unit.meet();
  return deed.work(arguments, unit);
}

}  // namespace

FcuWork declare_fcu_params(VerbOptions& options) {
  auto arguments = std::make_shared<ParamsArguments>();
  add_unit_address(options, arguments->address);
  options.option("deed", arguments->deed, "get, set, save, load, diff or verify").required();
  options.option("words", arguments->words, "names, values, or a file");
  options.flag("--keep", arguments->keep, "after set and load: write to the unit's flash");
  options.footer(
      "set and load are done when the unit has said every value back; only while it is disarmed. verify "
      "looks at what\n"
      "the file names, diff at everything. Files are YAML: - {name: NAME, type: 6 or 9, value: VALUE}; or "
      "scenarios, for\n"
      "the parameters that they and their vehicles name.\n"
      "Examples:\n"
      "  ironbird fcu params --port /dev/ttyACM0 get PID_ROLL_RATE_P RC_MAX_THR\n"
      "  ironbird fcu params --port /dev/ttyACM0 set RC_MAX_THR 0.9 --keep\n"
      "  ironbird fcu params --port /dev/ttyACM0 save before.yaml\n"
      "  ironbird fcu params --port /dev/ttyACM0 verify before.yaml\n"
      "  ironbird fcu params --port /dev/ttyACM0 load scenarios/library/paper/three_waypoints.toml --keep");
  return [arguments](const autopilot::Modules& modules) { return params(*arguments, modules); };
}

}  // namespace ironbird::scenarios
