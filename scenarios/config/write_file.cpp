#include "scenarios/config/write_file.hpp"

#include <fstream>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

void write_file(const std::filesystem::path& file, std::string_view text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (stream) return;
  const int reason = errno;
  // Half a file would be taken for a whole one. What is no file, as /dev/full, stays.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) std::filesystem::remove(file, ignored);
  throw UserError(with_remedy(file.string() + ": cannot be written: " + std::strerror(reason)));
}

}  // namespace ironbird::scenarios
