#pragma once

#include <filesystem>
#include <string>

namespace ironbird::hil_bridge::transport {

/// Who has made a pseudo-terminal and holds its other end: "process 4711 (ironbird)", or "another program"
/// where this user may not look.
/// @param terminal  /dev/pts/N
std::string owner_of_terminal(const std::filesystem::path& terminal);

}  // namespace ironbird::hil_bridge::transport
