#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace ironbird::scenarios {

/// More than any scenario has; a file above it was named by mistake.
inline constexpr std::uintmax_t kMostConfigBytes = 4U << 20U;

/// The text of a configuration file.
/// @param asked_by  what is put in front of an error, such as the place of an `include`; may be empty
/// @throws ConfigError in one line for what is missing (naming a file of nearly that name, beside it or in
/// the library), a folder, a device, larger than kMostConfigBytes or not to be read
std::string read_config_text(const std::filesystem::path& file, const std::string& asked_by);

}  // namespace ironbird::scenarios
