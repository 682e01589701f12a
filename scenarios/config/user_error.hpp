#pragma once

#include <stdexcept>
#include <string>

namespace ironbird::scenarios {

/// What whoever runs the program can mend: a file, the disk, a tool that is missing. Its text says what is
/// wrong and where, in one line, and what helps when that is not plain. Any other std::runtime_error is taken
/// for a defect of the program.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ironbird::scenarios
