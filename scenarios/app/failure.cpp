#include "scenarios/app/failure.hpp"

#include <csignal>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "hil_bridge/transport/byte_stream.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/config/write_file.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kPleaseReport =
    "please report it, with this line, the scenario, and what `ironbird --version` says";

template <class Kind>
bool is(const std::exception& error) {
  return dynamic_cast<const Kind*>(&error) != nullptr;
}

}  // namespace

Failure failure_of(const std::exception& error) {
  if (is<hil_bridge::transport::LinkError>(error)) return {kExitHardware, error.what()};
  if (const auto* at = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    const std::string place = at->path1().empty() ? "" : at->path1().string() + ": ";
    return {kExitUsage, with_remedy(place + at->code().message())};
  }
  if (is<UserError>(error) || is<std::invalid_argument>(error) || is<std::system_error>(error)) {
    return {kExitUsage, error.what()};
  }
  if (is<std::bad_alloc>(error)) {
    return {kExitUsage, "the machine has no memory left; fly fewer runs at once, see --jobs"};
  }
  return {kExitInternal, std::string("internal error: ") + error.what() + "; " + kPleaseReport};
}

Failure failure_of_signal(int signal) {
  const std::string what =
      "ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + "), without a verdict; ";
  switch (signal) {
    case SIGKILL:
      return {kExitInternal,
              what + "most often the machine has run out of memory: fly fewer runs at once, see --jobs"};
    case SIGINT:
    case SIGTERM:
    case SIGHUP:
      return {kExitInterrupted, what + "somebody ended it"};
    default:
      return {kExitInternal, what + "an error of the program or of a module in it: " + kPleaseReport};
  }
}

}  // namespace ironbird::scenarios
