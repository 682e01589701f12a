#include "scenarios/config/file_search.hpp"

#include <algorithm>
#include <system_error>

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;

void add(const fs::path& folder, std::vector<fs::path>& folders) {
  if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
}

void add_upwards(fs::path folder, std::vector<fs::path>& folders) {
  for (;; folder = folder.parent_path()) {
    add(folder, folders);
    if (folder == folder.root_path()) return;
  }
}

}  // namespace

std::vector<fs::path> search_folders(const fs::path& named_in) {
  std::vector<fs::path> folders;
  add_upwards(fs::absolute(named_in).lexically_normal().parent_path(), folders);
  add(fs::path(IRONBIRD_TREE), folders);
  add_upwards(fs::current_path(), folders);
  return folders;
}

fs::path find_named(const std::string& name, const std::vector<fs::path>& folders, const std::string& inner) {
  if (name.empty()) return {};
  std::error_code ignored;
  for (const fs::path& folder : folders) {
    const fs::path found = (folder / name).lexically_normal();
    if (fs::exists(inner.empty() ? found : found / inner, ignored)) return found;
  }
  return {};
}

fs::path library_folder() {
  return fs::path(IRONBIRD_TREE) / "scenarios/library";
}

fs::path readable(const fs::path& path) {
  const fs::path relative = path.lexically_relative(fs::current_path());
  return relative.empty() || *relative.begin() == ".." ? path : relative;
}

}  // namespace ironbird::scenarios
