#include "scenarios/record/log_bytes.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

std::vector<std::uint8_t> read_log_bytes(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw UserError(file.string() + ": cannot be opened: it is a folder; name the log in it");
  errno = 0;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream || !std::filesystem::is_regular_file(file, ignored)) {
    throw UserError(file.string() + ": cannot be opened: " +
                    (errno == ENOENT ? "there is no such file"
                     : errno == 0    ? "it is no file"
                                     : std::strerror(errno)));
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(stream.tellg()));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw UserError(file.string() + ": cannot be read");
  return bytes;
}

}  // namespace ironbird::scenarios
