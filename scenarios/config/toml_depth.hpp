#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// How many tables and arrays may lie in one another. Ours need six.
inline constexpr std::size_t kDeepestToml = 16;

/// Refuses a text with a key of more parts, as in `a.a.a.a = 1`. To be asked before it is parsed: each part
/// becomes a table in the last one, and they are taken down by recursion, which a long line could make
/// endless. (Brackets in one another the library itself bounds.)
/// @param name  stands for the text in messages
/// @throws ConfigError with the place
void refuse_long_keys(std::string_view text, std::string_view name);

/// Refuses what lies deeper. @throws ConfigError with the place
void refuse_depth(const toml::node& node, std::size_t depth = 0);

/// What is wrong with what lies deeper.
std::string too_deep();

}  // namespace ironbird::scenarios
