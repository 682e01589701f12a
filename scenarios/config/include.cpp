#include "scenarios/config/include.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {
namespace {

using Path = std::filesystem::path;

constexpr std::string_view kOption = "--set";

std::string read_text(const Path& file, const std::string& asked_by) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (std::filesystem::is_regular_file(file) && stream) text << stream.rdbuf();
  if (!std::filesystem::is_regular_file(file) || !stream) {
    throw ConfigError(asked_by + file.string() + ": cannot be opened");
  }
  return text.str();
}

/// Puts a node into a table without losing where it came from, which copying would.
void put(toml::table& table, std::string_view key, toml::node&& value) {
  std::move(value).visit([&](auto&& node) { table.insert_or_assign(key, std::move(node)); });
}

class Loader {
 public:
  explicit Loader(Path project_root) : project_root_(std::move(project_root)) {}

  toml::table load(const Path& file, const std::string& asked_by) {
    const Path identity = std::filesystem::weakly_canonical(file);
    if (std::find(open_.begin(), open_.end(), identity) != open_.end()) {
      throw ConfigError(asked_by + "include = \"" + file.string() +
                        "\": the files include each other in a circle");
    }
    open_.push_back(identity);
    toml::table own = parse_toml(read_text(file, asked_by), file.string());
    toml::table result;
    for (const auto& [included, from] : take_includes(own, file))
      merge_toml(result, load(included, from + ": "));
    merge_toml(result, std::move(own));
    open_.pop_back();
    return result;
  }

 private:
  /// The files that `own` includes, each with the place that says so. Removes the key.
  std::vector<std::pair<Path, std::string>> take_includes(toml::table& own, const Path& file) const {
    std::vector<std::pair<Path, std::string>> result;
    const toml::node* include = own.get("include");
    if (include == nullptr) return result;
    const toml::array* list = include->as_array();
    if (list == nullptr) {
      throw ConfigError(location(include->source()) + ": include: must be an array of paths");
    }
    for (const toml::node& element : *list) {
      const auto text = element.value<std::string>();
      if (!text) throw ConfigError(location(element.source()) + ": include: must be an array of paths");
      result.emplace_back(find(*text, file), location(element.source()));
    }
    own.erase("include");
    return result;
  }

  Path find(const std::string& name, const Path& from) const {
    const Path beside = (from.parent_path() / name).lexically_normal();
    if (std::filesystem::exists(beside)) return beside;
    const Path below_root = (project_root_ / name).lexically_normal();
    return std::filesystem::exists(below_root) ? below_root : beside;
  }

  Path project_root_;
  std::vector<Path> open_;
};

/// The value that a command line means by `text`.
toml::table parse_option(std::string_view path, std::string_view text) {
  const std::string name = std::string(kOption) + " " + std::string(path);
  try {
    toml::table parsed = toml::parse("value = " + std::string(text), name);
    if (parsed.size() == 1) return parsed;
  } catch (const toml::parse_error&) {
    // No TOML value: a text without quotes.
  }
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return toml::parse("value = \"" + quoted + "\"", name);
}

struct Step {
  std::string name;   ///< of a member, or empty
  std::size_t index;  ///< of an element, when the name is empty
};

std::vector<Step> split_path(std::string_view path) {
  const ConfigError wrong(std::string(kOption) + " " + std::string(path) +
                          ": is no path, such as plant.step");
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

}  // namespace

std::string location(const toml::source_region& source) {
  const std::string file = source.path ? *source.path : std::string("?");
  if (file.starts_with(kOption)) return std::string(kOption);
  return file + ":" + std::to_string(source.begin.line) + ":" + std::to_string(source.begin.column);
}

toml::table parse_toml(std::string_view text, std::string_view name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw ConfigError(location(error.source()) + ": " + std::string(error.description()));
  }
}

void merge_toml(toml::table& under, toml::table&& over) {
  for (auto&& [key, value] : over) {
    toml::node* below = under.get(key.str());
    if (below != nullptr && below->is_table() && value.is_table()) {
      merge_toml(*below->as_table(), std::move(*value.as_table()));
    } else {
      under.erase(key.str());
      std::move(value).visit(
          [&, name = toml::key(key)](auto&& node) { under.insert(name, std::move(node)); });
    }
  }
}

toml::table load_toml(const std::filesystem::path& file, const std::filesystem::path& project_root) {
  return Loader(project_root).load(file, "");
}

void set_value(toml::table& root, std::string_view path, std::string_view text) {
  const std::vector<Step> steps = split_path(path);
  toml::table parsed = parse_option(path, text);
  toml::node& value = *parsed.get("value");
  toml::node* at = &root;
  for (std::size_t i = 0; i + 1 < steps.size() && at != nullptr; ++i) at = descend(*at, steps[i]);
  const Step& last = steps.back();
  if (at != nullptr && !last.name.empty() && at->is_table())
    return put(*at->as_table(), last.name, std::move(value));
  toml::array* array = at == nullptr || !last.name.empty() ? nullptr : at->as_array();
  if (array == nullptr || last.index >= array->size()) {
    throw ConfigError(std::string(kOption) + " " + std::string(path) + ": there is no such place");
  }
  std::move(value).visit([&](auto&& node) {
    array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(last.index), std::move(node));
  });
}

}  // namespace ironbird::scenarios
