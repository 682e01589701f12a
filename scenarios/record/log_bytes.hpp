#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace ironbird::scenarios {

/// The whole file of a log. @throws UserError naming it and the reason when it cannot be read
std::vector<std::uint8_t> read_log_bytes(const std::filesystem::path& file);

}  // namespace ironbird::scenarios
