#include "scenarios/app/scene_text.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

namespace ironbird::scenarios {

namespace {

namespace fs = std::filesystem;

/// What an element reads from a file, and which attribute of <compiler> says where from.
struct AssetKind {
  std::string_view element;
  std::string_view folder;
};
constexpr AssetKind kAssets[] = {{"mesh", "meshdir"},
                                 {"skin", "meshdir"},
                                 {"hfield", "meshdir"},
                                 {"texture", "texturedir"},
                                 {"include", ""}};

/// Blanks the comments, so that every character keeps its place.
void blank_comments(std::string& text) {
  for (std::size_t at = 0; (at = text.find("<!--", at)) != std::string::npos;) {
    const std::size_t end = std::min(text.find("-->", at), text.size());
    for (; at < end; ++at) {
      if (text[at] != '\n') text[at] = ' ';
    }
  }
}

bool is_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

}  // namespace

SceneText::SceneText(const fs::path& file) : file_(file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  text_ = text.str();
  blank_comments(text_);
}

std::vector<SceneText::Element> SceneText::elements() const {
  std::vector<Element> found;
  for (std::size_t at = 0; (at = text_.find('<', at)) != std::string::npos; ++at) {
    std::size_t end = at + 1;
    while (end < text_.size() && is_name(text_[end])) ++end;
    found.push_back({text_.substr(at + 1, end - at - 1), at, std::min(text_.find('>', end), text_.size())});
  }
  return found;
}

std::string SceneText::attribute(const Element& element, const std::string& name) const {
  const std::string_view tag = std::string_view(text_).substr(element.begin, element.end - element.begin);
  for (std::size_t at = 0; (at = tag.find(name, at)) != std::string_view::npos; ++at) {
    const std::size_t equals = tag.find_first_not_of(" \t\r\n", at + name.size());
    if (is_name(tag[at - 1]) || equals == std::string_view::npos || tag[equals] != '=') continue;
    const std::size_t quote = tag.find_first_of("\"'", equals);
    if (quote == std::string_view::npos) return "";
    return std::string(tag.substr(quote + 1, tag.find(tag[quote], quote + 1) - quote - 1));
  }
  return "";
}

std::string SceneText::place(std::size_t offset) const {
  const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
  return file_.string() + ":" + std::to_string(lines + 1);
}

std::vector<std::string> SceneText::missing_files(const fs::path& folder) const {
  const std::vector<Element> all = elements();
  const auto folder_of = [&](std::string_view key) {
    std::string name;
    for (const Element& element : all) {
      if (element.name == "compiler" && !key.empty()) name = attribute(element, std::string(key));
    }
    return folder / name;
  };
  std::vector<std::string> missing;
  for (const Element& element : all) {
    for (const AssetKind& kind : kAssets) {
      const std::string name = element.name == kind.element ? attribute(element, "file") : "";
      const fs::path path = (folder_of(kind.folder) / name).lexically_normal();
      std::error_code ignored;
      if (name.empty() || fs::is_regular_file(path, ignored)) continue;
      missing.push_back(place(element.begin) + ": " + element.name + " \"" + name + "\": there is no file " +
                        path.string() + "; a path is relative to the vehicle's folder" +
                        (kind.folder.empty() ? "" : " and its " + std::string(kind.folder)));
    }
  }
  return missing;
}

std::string SceneText::located(const std::string& wrong) const {
  for (std::size_t quote = 0; (quote = wrong.find('\'', quote)) != std::string::npos; ++quote) {
    const std::string word = wrong.substr(quote + 1, wrong.find('\'', quote + 1) - quote - 1);
    for (const std::string& written : {"\"" + word + "\"", "'" + word + "'", " " + word + "="}) {
      const std::size_t at = text_.find(written);
      if (!word.empty() && at != std::string::npos) return place(at) + ": " + wrong;
    }
  }
  return file_.string() + ": " + wrong;
}

}  // namespace ironbird::scenarios
