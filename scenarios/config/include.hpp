#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// Reads a TOML file with everything that it includes: `include = ["other.toml", ...]`, each looked for in
/// the search_folders() of the file.
///
/// Included tables lie below the including file: its own values win, tables merge, arrays replace. Of several
/// included files a later one wins. Every node keeps the file, line and column that it came from.
/// @throws ConfigError for a file that is missing or no TOML, and for files that include each other in a
/// circle
toml::table load_toml(const std::filesystem::path& file);

/// The same for a text; `name` stands for the file in messages.
toml::table parse_toml(std::string_view text, std::string_view name);

/// The table as TOML that reads back to the same table.
std::string print_toml(const toml::table& table);

/// Lays `over` on `under`: values of `over` win, tables merge, arrays replace.
/// @throws ConfigError when one has a table where the other has none: neither could win without a loss
void merge_toml(toml::table& under, toml::table&& over);

/// Sets one value of a table, as `--set path=text` asks. Steps of the path are names divided by dots; an
/// element of an array is `[i]`. A text that is no TOML value is taken as a string, so that `25 deg` needs no
/// quotes. Tables are made when missing.
/// @throws ConfigError when the path leads through something that is no table, or to no element
void set_value(toml::table& root, std::string_view path, std::string_view text);

/// `file:line:column` of a node or key; `--set path=text` for what the command line gave; empty for what has
/// no place.
std::string location(const toml::source_region& source);

/// The same for a node. A table without a place, such as one that set_value() has made, is where its first
/// member is.
std::string place_of(const toml::node& node);

}  // namespace ironbird::scenarios
