#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ironbird::scenarios {

/// The text of a scene file, to say where in it something is wrong: the engine that reads it does not tell.
class SceneText {
 public:
  explicit SceneText(const std::filesystem::path& file);

  /// The meshes, textures and other files that it names and that are not there, one line each, with the
  /// place.
  /// @param folder  from which the engine looks for them
  std::vector<std::string> missing_files(const std::filesystem::path& folder) const;

  /// Puts the place in front of what is wrong: with the line of the first word in quotes that the file has,
  /// when it has one.
  std::string located(const std::string& wrong) const;

 private:
  struct Element {
    std::string name;
    std::size_t begin = 0;  // of its start tag
    std::size_t end = 0;
  };

  std::vector<Element> elements() const;
  std::string attribute(const Element& element, const std::string& name) const;
  std::string place(std::size_t offset) const;

  std::filesystem::path file_;
  std::string text_;  // comments blanked
};

}  // namespace ironbird::scenarios
