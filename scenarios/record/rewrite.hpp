#pragma once

#include <filesystem>

#include "scenarios/record/mcap_writer.hpp"

namespace ironbird::scenarios {

/// Writes the whole records of a log of ours again in another layout, for example a journal in compressed
/// chunks once the flight is over. Metadata comes last.
/// @param to  another file than `from`
/// @throws std::runtime_error when a file cannot be read or written, or a channel is no ROS 2 topic
void rewrite_log(const std::filesystem::path& from, const std::filesystem::path& to,
                 const McapOptions& options);

}  // namespace ironbird::scenarios
