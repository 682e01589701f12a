#include "scenarios/replay/column_map.hpp"

#include <string_view>
#include <utility>

#include "scenarios/config/include.hpp"
#include "scenarios/config/toml_reader.hpp"

namespace ironbird::scenarios {

namespace {

/// Where the innermost table or value of a path that there is stands.
std::string nearest_place(const toml::table& table, std::string_view path) {
  for (;;) {
    if (const auto node = toml::at_path(table, path)) return place_of(*node.node());
    const std::size_t dot = path.rfind('.');
    if (dot == std::string_view::npos) return "";
    path = path.substr(0, dot);
  }
}

}  // namespace

ConfigError LoadedColumnMap::error(const std::string& path, const std::string& what) const {
  const std::string place = nearest_place(table, path);
  return ConfigError((place.empty() ? file.string() : place) + ": " + path + ": " + what);
}

LoadedColumnMap load_column_map(const std::filesystem::path& file,
                                const std::vector<std::pair<std::string, std::string>>& settings) {
  toml::table root;
  root.insert_or_assign("map", load_toml(file));
  for (const auto& [path, text] : settings) set_value(root, path, text);
  LoadedColumnMap loaded{file, std::move(*root.get_as<toml::table>("map")), {}};
  read_toml(loaded.table, loaded.map);
  return loaded;
}

}  // namespace ironbird::scenarios
