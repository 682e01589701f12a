#pragma once

#include <string>

namespace ironbird::simulator {

/// What an engine's message about a scene says, in one line and without what only the engine's makers need:
/// how it came to read the file, numbers of its own, lines and columns that it does not know.
std::string plain_words(const std::string& message);

}  // namespace ironbird::simulator
