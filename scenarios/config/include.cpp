#include "scenarios/config/include.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "scenarios/config/config_error.hpp"
#include "scenarios/config/file_search.hpp"
#include "scenarios/config/text_file.hpp"
#include "scenarios/config/toml_depth.hpp"

namespace ironbird::scenarios {
namespace {

using Path = std::filesystem::path;

constexpr std::string_view kOption = "--set";

/// How many files one may read, itself and each as often as it is included. Files that each include the next
/// one twice would double it with each.
constexpr std::size_t kMostFiles = 256;

/// Puts a node into a table without losing where it came from, which copying would.
void put(toml::table& table, std::string_view key, toml::node&& value) {
  std::move(value).visit([&](auto&& node) { table.insert_or_assign(key, std::move(node)); });
}

class Loader {
 public:
  toml::table load(const Path& file, const std::string& asked_by) {
    if (++files_ > kMostFiles) {
      throw ConfigError(asked_by + "include = \"" + file.string() + "\": more than " +
                        std::to_string(kMostFiles) + " files would be read, each as often as it is included");
    }
    const std::string text = read_config_text(file, asked_by);
    std::error_code ignored;
    const Path identity = std::filesystem::weakly_canonical(file, ignored);
    if (std::find(open_.begin(), open_.end(), identity) != open_.end()) {
      throw ConfigError(asked_by + "include = \"" + file.string() +
                        "\": the files include each other in a circle");
    }
    open_.push_back(identity);
    toml::table own = parse_toml(text, file.string());
    toml::table result;
    for (const auto& [included, from] : take_includes(own, file))
      merge_toml(result, load(included, from + ": "));
    merge_toml(result, std::move(own));
    open_.pop_back();
    return result;
  }

 private:
  /// The files that `own` includes, each with the place that says so. Removes the key.
  static std::vector<std::pair<Path, std::string>> take_includes(toml::table& own, const Path& file) {
    std::vector<std::pair<Path, std::string>> result;
    const toml::node* include = own.get("include");
    if (include == nullptr) return result;
    const toml::array* list = include->as_array();
    if (list == nullptr) {
      throw ConfigError(place_of(*include) + ": include: must be an array of paths");
    }
    for (const toml::node& element : *list) {
      const auto text = element.value<std::string>();
      if (!text) throw ConfigError(place_of(element) + ": include: must be an array of paths");
      if (text->empty()) throw ConfigError(place_of(element) + ": include = [\"\"]: must name a file");
      result.emplace_back(find(*text, file), place_of(element));
    }
    own.erase("include");
    return result;
  }

  /// Beside the including file when there is none, so that the message names the place that was meant.
  static Path find(const std::string& name, const Path& from) {
    const Path beside = (from.parent_path() / name).lexically_normal();
    std::error_code ignored;
    if (std::filesystem::exists(beside, ignored)) return beside;
    const Path found = find_named(name, search_folders(from));
    return found.empty() ? beside : readable(found);
  }

  std::vector<Path> open_;
  std::size_t files_ = 0;
};

std::string shortened(std::string_view text) {
  constexpr std::size_t kMost = 60;
  return text.size() <= kMost ? std::string(text) : std::string(text.substr(0, kMost)) + "...";
}

/// The value that a command line means by `text`. @param name  of the option, for messages
toml::table parse_option(std::string_view text, const std::string& name) {
  const std::string line = "value = " + std::string(text);
  try {
    refuse_long_keys(line, name);
    toml::table parsed = toml::parse(line, name);
    if (parsed.size() == 1) return parsed;
  } catch (const toml::parse_error&) {
    // No TOML value: a text without quotes.
  } catch (const ConfigError&) {
    // None that we would take, and many dots are no fault of a text.
  }
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return parse_toml("value = \"" + quoted + "\"", name);
}

struct Step {
  std::string name;   ///< of a member, or empty
  std::size_t index;  ///< of an element, when the name is empty
};

std::vector<Step> split_path(std::string_view path) {
  const ConfigError wrong(std::string(kOption) + " " + std::string(path) +
                          ": is no path, such as plant.engine or waypoint[0].heading");
  std::vector<Step> steps;
  while (!path.empty()) {
    if (path.front() == '[') {
      std::size_t index = 0;
      const auto result = std::from_chars(path.data() + 1, path.data() + path.size(), index);
      if (result.ec != std::errc() || result.ptr == path.data() + path.size() || *result.ptr != ']')
        throw wrong;
      steps.push_back({"", index});
      path.remove_prefix(static_cast<std::size_t>(result.ptr - path.data()) + 1);
    } else {
      if (!steps.empty() && path.front() == '.') path.remove_prefix(1);
      const std::string_view name = path.substr(0, path.find_first_of(".["));
      if (name.empty()) throw wrong;
      steps.push_back({std::string(name), 0});
      path.remove_prefix(name.size());
    }
  }
  if (steps.empty() || steps.front().name.empty()) throw wrong;
  return steps;
}

/// The node that `step` leads to; a missing member becomes a table.
toml::node* descend(toml::node& from, const Step& step) {
  if (step.name.empty()) {
    toml::array* array = from.as_array();
    return array == nullptr || step.index >= array->size() ? nullptr : array->get(step.index);
  }
  toml::table* table = from.as_table();
  if (table == nullptr) return nullptr;
  if (table->get(step.name) == nullptr) table->insert(step.name, toml::table{});
  return table->get(step.name);
}

/// How far the path leads, for the message that it leads nowhere.
std::string what_is_there(toml::table& root, const std::vector<Step>& steps) {
  const toml::node* at = &root;
  std::string path;
  for (const Step& step : steps) {
    const toml::table* table = at->as_table();
    const toml::array* array = at->as_array();
    const std::string next =
        step.name.empty() ? "[" + std::to_string(step.index) + "]" : (path.empty() ? "" : ".") + step.name;
    const toml::node* inner = nullptr;
    if (table != nullptr && !step.name.empty()) inner = table->get(step.name);
    if (array != nullptr && step.name.empty()) inner = array->get(step.index);
    if (inner == nullptr) {
      if (array != nullptr)
        return ": " + path + " has " + std::to_string(array->size()) + " elements, from [0]";
      if (table != nullptr && table->empty())  // made on the way here
        return ": the file has no [[" + path + "]]; write one there";
      return table != nullptr ? ": " + path + " is a table" : ": " + path + " is a single value";
    }
    at = inner;
    path += next;
  }
  return "";
}

[[noreturn]] void refuse_mixture(const std::string& path, const toml::node& below, const toml::node& above) {
  const auto form = [&](const toml::node& node) {
    return node.is_table() ? "a table, [" + path + "]," : node.is_array() ? "an array" : "a value";
  };
  throw ConfigError(place_of(above) + ": " + path + ": is " + form(above) + " here and " + form(below) +
                    " in " + place_of(below) + "; write it as there");
}

void merge_below(toml::table& under, toml::table&& over, const std::string& prefix) {
  for (auto&& [key, value] : over) {
    const std::string path = prefix + std::string(key.str());
    toml::node* below = under.get(key.str());
    if (below != nullptr && below->is_table() != value.is_table()) refuse_mixture(path, *below, value);
    if (below != nullptr && below->is_table()) {
      merge_below(*below->as_table(), std::move(*value.as_table()), path + ".");
    } else {
      under.erase(key.str());
      std::move(value).visit(
          [&, name = toml::key(key)](auto&& node) { under.insert(name, std::move(node)); });
    }
  }
}

}  // namespace

std::string location(const toml::source_region& source) {
  if (!source.path) return "";
  if (source.path->starts_with(kOption)) return *source.path;
  return *source.path + ":" + std::to_string(source.begin.line) + ":" + std::to_string(source.begin.column);
}

std::string place_of(const toml::node& node) {
  const std::string own = location(node.source());
  if (!own.empty()) return own;
  // A table that an option made on the way to a value is where that value is.
  std::string found;
  if (const toml::table* table = node.as_table()) {
    for (auto at = table->cbegin(); at != table->cend() && found.empty(); ++at) found = place_of(at->second);
  }
  return found;
}

toml::table parse_toml(std::string_view text, std::string_view name) {
  refuse_long_keys(text, name);
  try {
    toml::table table = toml::parse(text, name);
    refuse_depth(table);
    return table;
  } catch (const toml::parse_error& error) {
    throw ConfigError(location(error.source()) + ": " + std::string(error.description()));
  }
}

std::string print_toml(const toml::table& table) {
  const auto printed = [&](toml::format_flags flags) {
    std::ostringstream text;
    text << toml::toml_formatter(table, flags);
    return text.str();
  };
  constexpr auto kUsual = toml::toml_formatter::default_flags;
  constexpr auto kInLines =
      toml::format_flags::allow_multi_line_strings | toml::format_flags::allow_literal_strings;
  std::string text = printed(kUsual);
  // Of a text in several lines that begins with an empty one, this library forgets that one when it reads it
  // back.
  const bool in_lines = text.find("'''") != std::string::npos || text.find("\"\"\"") != std::string::npos;
  return in_lines ? printed(kUsual & ~kInLines) : text;
}

void merge_toml(toml::table& under, toml::table&& over) {
  merge_below(under, std::move(over), "");
}

toml::table load_toml(const std::filesystem::path& file) {
  return Loader().load(file, "");
}

void set_value(toml::table& root, std::string_view path, std::string_view text) {
  const std::vector<Step> steps = split_path(path);
  if (steps.size() > kDeepestToml)
    throw ConfigError(std::string(kOption) + " " + shortened(path) + too_deep());
  const std::string name = std::string(kOption) + " " + std::string(path) + "=" + shortened(text);
  toml::table parsed = parse_option(text, name);
  toml::node& value = *parsed.get("value");
  refuse_depth(value, steps.size());
  toml::node* at = &root;
  for (std::size_t i = 0; i + 1 < steps.size() && at != nullptr; ++i) at = descend(*at, steps[i]);
  const Step& last = steps.back();
  if (at != nullptr && !last.name.empty() && at->is_table())
    return put(*at->as_table(), last.name, std::move(value));
  toml::array* array = at == nullptr || !last.name.empty() ? nullptr : at->as_array();
  if (array == nullptr || last.index >= array->size()) {
    throw ConfigError(name + ": there is no such place" + what_is_there(root, steps));
  }
  std::move(value).visit([&](auto&& node) {
    array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(last.index), std::move(node));
  });
}

}  // namespace ironbird::scenarios
