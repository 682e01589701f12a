#pragma once

#include <functional>
#include <memory>
#include <string>

#include "autopilot/modules.hpp"

namespace ironbird::scenarios {

class VerbOptions;

/// One verb of the program. `declare` says what it takes and returns what runs it.
struct Verb {
  const char* name;
  const char* summary;
  std::function<std::function<int(const autopilot::Modules&)>(VerbOptions&)> declare;
};

Verb run_verb();
Verb check_verb();
Verb fcu_verb();
Verb replay_verb();
Verb report_verb();
Verb snapshot_verb();
Verb topics_verb();
Verb video_verb();

/// The whole program: reads the command line, runs one verb, reports errors in one line.
/// @param modules  the kinds of module that scenarios can name; a researcher adds their own to
/// standard_modules()
/// @return the exit code
int run_command_line(int argc, char** argv, const autopilot::Modules& modules);

}  // namespace ironbird::scenarios
