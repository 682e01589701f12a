#include "scenarios/config/write_file.hpp"

#include <fstream>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

void write_file(const std::filesystem::path& file, std::string_view text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw UserError(with_remedy(file.string() + ": cannot be written: " + std::strerror(errno)));
}

}  // namespace ironbird::scenarios
