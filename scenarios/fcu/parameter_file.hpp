#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hil_bridge/serial_fcu/parameter_set.hpp"

namespace ironbird::scenarios {

/// A unit's parameters as the YAML file that the usual companion reads and writes: a sequence of
/// `{name: NAME, type: 6 or 9, value: VALUE}`. A real number is written so that it reads back to the same
/// bits.
std::string parameter_file_text(const std::vector<hil_bridge::ParameterRecord>& records);

/// Writes the file whole or not at all. @throws UserError
void write_parameter_file(const std::filesystem::path& file,
                          const std::vector<hil_bridge::ParameterRecord>& records);

/// What a parameter's value must be, when it is not; else empty.
using ParameterJudge = std::function<std::string(const hil_bridge::ParameterRecord&)>;

/// Reads all of a file or nothing. @param judge  is asked about every value, when there is one
/// @throws ConfigError with every finding, `file:line:column: what is wrong`: no YAML or more than one
/// document, an entry that is not one, a key that it cannot have or has twice, a value that its type cannot
/// hold or that the judge refuses, a name that comes twice
std::vector<hil_bridge::ParameterRecord> read_parameter_file(const std::filesystem::path& file,
                                                             const ParameterJudge& judge = {});

}  // namespace ironbird::scenarios
