#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace ironbird::scenarios {

/// What a verb takes from the command line. Values that are bound here must outlive the reading of it.
/// Its source and command_line.cpp alone include the library that reads command lines, all of which is in
/// headers; `ci/check_layers` sees to it.
class VerbOptions {
 public:
  /// What else holds of an option.
  class Option {
   public:
    explicit Option(CLI::Option* option) : option_(option) {}
    /// A command line without it is refused.
    Option& required();
    /// The help says what the value is when nothing is said.
    Option& shows_default();
    /// Values outside are refused. Both ends are inside.
    Option& within(int least, int most);
    Option& within(double least, double most);
    /// What the help calls its value, such as PATH=VALUE.
    Option& called(const char* what);
    /// Takes one word each time that it is given, and not all words that follow.
    Option& one_word_each();

   private:
    CLI::Option* option_;
  };

  explicit VerbOptions(CLI::App& app) : app_(app) {}

  /// @param names  "--out", several with commas; without dashes: a word at its place
  Option option(const char* names, std::string& value, const std::string& help);
  /// Tells an empty word from none.
  Option option(const char* names, std::optional<std::string>& value, const std::string& help);
  Option option(const char* names, std::vector<std::string>& values, const std::string& help);
  Option option(const char* names, int& value, const std::string& help);
  Option option(const char* names, double& value, const std::string& help);
  /// @param value  true afterwards when one of the names is given
  void flag(const char* names, bool& value, const std::string& help);
  /// What the help ends with: what is worth knowing, and examples.
  void footer(const std::string& text);

  /// A verb of this verb. `chosen` is called when the command line names it.
  /// @param declare  adds its options, and returns `chosen`
  void verb(const char* name, const char* summary,
            const std::function<std::function<void()>(VerbOptions&)>& declare);
  /// A command line without one of its verbs is refused.
  void requires_verb();

 private:
  CLI::App& app_;
};

}  // namespace ironbird::scenarios
