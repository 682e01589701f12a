#include "scenarios/config/text_file.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include "scenarios/config/config_error.hpp"
#include "scenarios/config/file_search.hpp"
#include "scenarios/config/nearest_name.hpp"

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;

/// Of the TOML files that this iterator comes by, the one whose name is nearest to that of `file`, or
/// nothing.
template <class Iterator>
fs::path nearest_of(const fs::path& folder, const fs::path& file) {
  std::vector<fs::path> files;
  std::error_code error;
  for (Iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (at->path().extension() == ".toml") files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());  // a folder has no order of its own
  std::vector<std::string> names;
  for (const fs::path& known : files) names.push_back(known.stem().string());
  const auto found = std::find(names.begin(), names.end(), nearest_name(file.stem().string(), names));
  return found == names.end() ? fs::path() : files[static_cast<std::size_t>(found - names.begin())];
}

/// A file that `file` may have meant: one beside it or, of a scenario, one of the library. Or nothing.
std::string meant_instead_of(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const fs::path beside = nearest_of<fs::directory_iterator>(folder, file);
  if (!beside.empty()) return (file.parent_path() / beside.filename()).string();
  const bool may_be_scenario = file.extension() == ".toml" || !file.has_extension();
  if (!may_be_scenario) return "";
  return readable(nearest_of<fs::recursive_directory_iterator>(library_folder(), file)).string();
}

/// Why the file cannot be taken, or nothing.
std::string why_unreadable(const fs::path& file) {
  if (file.empty()) return "the name of the file is empty; name a TOML file";
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) {
    const std::string nearest = meant_instead_of(file);
    return "cannot be opened: there is no such file" +
           (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
  }
  if (error) return "cannot be opened: " + error.message();
  if (fs::is_directory(status)) return "is a folder, must be a TOML file";
  if (!fs::is_regular_file(status)) return "is no regular file, must be a TOML file";
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return "cannot be opened: " + error.message();
  if (size <= kMostConfigBytes) return "";
  return "has " + std::to_string(size) + " bytes, a configuration has at most " +
         std::to_string(kMostConfigBytes);
}

}  // namespace

std::string read_config_text(const fs::path& file, const std::string& asked_by) {
  const std::string wrong = why_unreadable(file);
  if (!wrong.empty()) throw ConfigError(asked_by + (file.empty() ? "" : file.string() + ": ") + wrong);
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (stream.bad() || !stream.is_open())
    throw ConfigError(asked_by + file.string() + ": cannot be read; look at its permissions");
  return text.str();
}

}  // namespace ironbird::scenarios
