#include "scenarios/app/interrupt.hpp"

#include <csignal>

namespace ironbird::scenarios {

namespace {

// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t signal_heard = 0;

void note(int) {
  signal_heard = 1;
}

}  // namespace

void note_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second Ctrl-C ends the program
  // A file that grows too large is an error of its write, told in a line, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupt_requested() {
  return signal_heard != 0;
}

}  // namespace ironbird::scenarios
