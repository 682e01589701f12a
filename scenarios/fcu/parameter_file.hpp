#pragma once

#include <filesystem>
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

/// @throws ConfigError with every finding, `file:line: what is wrong`: no YAML, an entry that is not one, a
/// value that its type cannot hold, a name that comes twice
std::vector<hil_bridge::ParameterRecord> read_parameter_file(const std::filesystem::path& file);

}  // namespace ironbird::scenarios
