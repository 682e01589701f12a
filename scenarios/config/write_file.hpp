#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// A message that a file could not be written, with what helps behind it when the system's words in it are
/// about room or permission.
inline std::string with_remedy(std::string message) {
  constexpr struct {
    int reason;
    const char* remedy;
  } kRemedies[] = {{ENOSPC, "; make room there, or name another place on the command line"},
                   {EDQUOT, "; make room there, or name another place on the command line"},
                   {EFBIG, "; raise the limit, see `ulimit -f`, or name another place on the command line"},
                   {EACCES, "; name another place on the command line"},
                   {EROFS, "; name another place on the command line"}};
  for (const auto& [reason, remedy] : kRemedies) {
    if (message.find(std::strerror(reason)) != std::string::npos) return message + remedy;
  }
  return message;
}

/// Finds out before the work that a file could not be written: it is a folder, its folder is not there or
/// takes no file. @throws UserError naming it, the reason and what helps
void check_writable(const std::filesystem::path& file);

/// Makes a folder for results, and those above it. @throws UserError naming it, the reason and what helps
void make_folder(const std::filesystem::path& folder);

/// Writes a file whole or not at all: what was there before stays until the new one is complete. @throws
/// UserError naming it, the reason and what helps
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace ironbird::scenarios
