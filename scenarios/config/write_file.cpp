#include "scenarios/config/write_file.hpp"

#include <fstream>
#include <system_error>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

void write_file(const std::filesystem::path& file, std::string_view text) {
  std::error_code error;
  const auto there = std::filesystem::status(file, error);
  // What is no file, as /dev/full, can only be written into.
  const bool beside = !std::filesystem::exists(there) || std::filesystem::is_regular_file(there);
  const std::filesystem::path target = beside ? file.string() + ".part" : file.string();
  errno = 0;
  std::ofstream stream(target, std::ios::binary);
  stream << text;
  stream.close();
  std::string reason = stream ? "" : std::strerror(errno);
  if (beside && reason.empty()) {
    std::filesystem::rename(target, file, error);
    if (error) reason = error.message();
  }
  if (reason.empty()) return;
  if (beside) std::filesystem::remove(target, error);
  throw UserError(with_remedy(file.string() + ": cannot be written: " + reason));
}

}  // namespace ironbird::scenarios
