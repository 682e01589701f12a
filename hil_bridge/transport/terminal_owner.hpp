#pragma once

#include <filesystem>
#include <string>

namespace ironbird::hil_bridge::transport {

/// Who has made a pseudo-terminal and holds its other end: "process 4711 (ironbird)", or "another program"
/// where this user may not look.
/// @param terminal  /dev/pts/N
std::string owner_of_terminal(const std::filesystem::path& terminal);

/// Which process but this one has a serial device open, the maker of a pseudo-terminal aside:
/// "process 4711 (minicom)", or nothing where there is none or this user may not look.
/// @param device  may be a link to it
std::string user_of_device(const std::filesystem::path& device);

}  // namespace ironbird::hil_bridge::transport
