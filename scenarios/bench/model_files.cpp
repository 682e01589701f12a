#include "scenarios/bench/model_files.hpp"

#include <set>
#include <system_error>

#include "scenarios/config/file_search.hpp"

namespace ironbird::scenarios {

namespace {

namespace fs = std::filesystem;

bool is_vehicle(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path / kVehicleFile, ignored);
}

bool is_field(const fs::path& path) {
  return path.extension() == ".xml";
}

/// Adds what `is_one` takes of a folder's inhabitants, with `prefix` in front of their names.
void add_names(const fs::path& folder, const std::string& prefix, bool (*is_one)(const fs::path&),
               std::set<std::string>& names) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (is_one(at->path())) names.insert(prefix + at->path().filename().string());
  }
}

std::string joined_names(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "there are: " : ", ") + name;
  return text.empty() ? "there are none near" : text;
}

}  // namespace

fs::path find_vehicle(const std::string& name, const std::vector<fs::path>& folders) {
  return find_named(name, folders, kVehicleFile);
}

fs::path find_field(const std::string& name, const std::vector<fs::path>& folders) {
  const fs::path found = find_named(name, folders);
  std::error_code ignored;
  return fs::is_regular_file(found, ignored) ? found : fs::path();
}

std::string vehicles_in(const std::vector<fs::path>& folders) {
  std::set<std::string> names;
  add_names(folders.front(), "", is_vehicle, names);
  for (const fs::path& folder : folders) add_names(folder / "models", "models/", is_vehicle, names);
  return joined_names(names);
}

std::string fields_in(const std::vector<fs::path>& folders) {
  std::set<std::string> names;
  for (const fs::path& folder : folders)
    add_names(folder / "models/fields", "models/fields/", is_field, names);
  return joined_names(names);
}

}  // namespace ironbird::scenarios
