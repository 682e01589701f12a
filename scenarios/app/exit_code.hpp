#pragma once

namespace ironbird::scenarios {

/// What the program's exit code says.
enum ExitCode : int {
  kExitPass = 0,          ///< all checks hold
  kExitFail = 1,          ///< a check failed
  kExitUsage = 2,         ///< wrong usage or configuration
  kExitHardware = 3,      ///< hardware or link
  kExitInternal = 4,      ///< an error of the program itself
  kExitInconclusive = 5,  ///< inconclusive or invalid: the bench broke one of its own promises
  kExitInterrupted = 130  ///< Ctrl-C
};

}  // namespace ironbird::scenarios
