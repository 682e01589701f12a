#include "autopilot/modules.hpp"
#include "scenarios/app/command_line.hpp"

int main(int argc, char** argv) {
  return ironbird::scenarios::run_command_line(argc, argv, ironbird::autopilot::standard_modules());
}
