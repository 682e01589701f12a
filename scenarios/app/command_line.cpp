#include "scenarios/app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/failure.hpp"
#include "scenarios/app/reproducible_math.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/config/write_file.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kVersion = IRONBIRD_VERSION;

using Work = std::function<int(const autopilot::Modules&)>;

std::string guess(const std::string& word, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word, names);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

/// @throws ConfigError when the first word is no verb
void check_verb_name(const std::string& word, const std::vector<std::string>& verbs) {
  if (word.starts_with('-') || std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return;
  std::string all;
  for (const std::string& verb : verbs) all += (all.empty() ? "" : ", ") + verb;
  const std::string hint = guess(word, verbs);
  throw ConfigError(word + ": there is no such verb" + (hint.empty() ? "; there are: " + all : hint));
}

/// What to say of words that the verb does not take.
std::string about_extras(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    std::vector<std::string> options;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    }
    for (const std::string& word : command->remaining(true)) {
      const std::string hint = guess(word.substr(0, word.find('=')), options);
      return word + ": " + command->get_name() + " does not take this" + hint +
             (hint.empty() ? "; see" : " See") + " ironbird " + command->get_name() + " --help";
    }
  }
  return "there are words too many; see ironbird --help";
}

/// Reads the command line. @return the exit code when nothing is left to do
std::optional<int> parsed(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ExtrasError&) {
    throw ConfigError(about_extras(app));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app.exit(error);  // help or version, on standard output
      return kExitPass;
    }
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    throw ConfigError(std::string(error.what()) + "; see ironbird " +
                      (chosen.empty() ? "" : chosen.front()->get_name() + " ") + "--help");
  }
}

int run_verb_of(CLI::App& app, int argc, char** argv, const autopilot::Modules& modules) {
  const std::array<Verb, 8> verbs = {run_verb(),   check_verb(),    replay_verb(), report_verb(),
                                     video_verb(), snapshot_verb(), fcu_verb(),    topics_verb()};
  Work chosen;
  std::vector<std::string> names;
  VerbOptions all(app);
  for (const Verb& verb : verbs) {
    names.emplace_back(verb.name);
    all.verb(verb.name, verb.summary, [&](VerbOptions& options) {
      return [&chosen, work = verb.declare(options)] { chosen = work; };
    });
  }
  if (argc < 2) {
    std::fputs(app.help().c_str(), stderr);
    return kExitUsage;
  }
  check_verb_name(argv[1], names);
  if (const std::optional<int> code = parsed(app, argc, argv)) return *code;
  return chosen(modules);
}

}  // namespace

int run_command_line(int argc, char** argv, const autopilot::Modules& modules) {
  CLI::App app{"Ironbird: a hardware-in-the-loop bench for multirotor autopilots", "ironbird"};
  app.require_subcommand(1);
  app.set_version_flag(
      "--version", std::string("ironbird ") + kVersion + ", elementary functions: " + reproducible_math());
  app.footer(
      "Exit codes: 0 all checks hold, 1 a check failed, 2 usage or configuration, 3 hardware or link,\n"
      "4 internal error, 5 inconclusive or invalid, 130 interrupted.\n"
      "ironbird VERB --help says more, with examples.\n"
      "Start with: ironbird run scenarios/library/paper/three_waypoints.toml");
  try {
    const int code = run_verb_of(app, argc, argv, modules);
    errno = 0;
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    throw UserError(with_remedy(std::string("standard output: cannot be written: ") +
                                std::strerror(errno == 0 ? ENOSPC : errno)));
  } catch (const std::exception& error) {
    const Failure failure = failure_of(error);
    std::fprintf(stderr, "%s\n", failure.text.c_str());
    return failure.exit_code;
  }
}

}  // namespace ironbird::scenarios
