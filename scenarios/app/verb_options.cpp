#include "scenarios/app/verb_options.hpp"

#include <CLI/CLI.hpp>

namespace ironbird::scenarios {

namespace {

/// No text that is asked for may be empty: mostly it is a variable of the shell that was never set.
std::string refuse_empty(const std::string& text) {
  return text.empty() ? "must not be empty" : "";
}

}  // namespace

VerbOptions::Option& VerbOptions::Option::required() {
  option_->required();
  return *this;
}

VerbOptions::Option& VerbOptions::Option::shows_default() {
  option_->capture_default_str();
  return *this;
}

VerbOptions::Option& VerbOptions::Option::within(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

VerbOptions::Option& VerbOptions::Option::within(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

VerbOptions::Option& VerbOptions::Option::called(const char* what) {
  option_->type_name(what);
  return *this;
}

VerbOptions::Option& VerbOptions::Option::one_word_each() {
  option_->allow_extra_args(false)->take_all();
  return *this;
}

VerbOptions::Option VerbOptions::option(const char* names, std::string& value, const std::string& help) {
  return Option(app_.add_option(names, value, help)->check(refuse_empty));
}

VerbOptions::Option VerbOptions::option(const char* names, std::optional<std::string>& value,
                                        const std::string& help) {
  return Option(app_.add_option(names, value, help)->check(refuse_empty));
}

VerbOptions::Option VerbOptions::option(const char* names, std::vector<std::string>& values,
                                        const std::string& help) {
  return Option(app_.add_option(names, values, help)->check(refuse_empty));
}

VerbOptions::Option VerbOptions::option(const char* names, int& value, const std::string& help) {
  return Option(app_.add_option(names, value, help));
}

VerbOptions::Option VerbOptions::option(const char* names, double& value, const std::string& help) {
  return Option(app_.add_option(names, value, help));
}

void VerbOptions::flag(const char* names, bool& value, const std::string& help) {
  app_.add_flag(names, value, help);
}

void VerbOptions::footer(const std::string& text) {
  app_.footer(text);
}

void VerbOptions::verb(const char* name, const char* summary,
                       const std::function<std::function<void()>(VerbOptions&)>& declare) {
  CLI::App* const command = app_.add_subcommand(name, summary);
  VerbOptions options(*command);
  command->callback(declare(options));
}

void VerbOptions::requires_verb() {
  app_.require_subcommand(1);
}

}  // namespace ironbird::scenarios
