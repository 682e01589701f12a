#include "hil_bridge/transport/terminal_owner.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

namespace ironbird::hil_bridge::transport {

namespace fs = std::filesystem;

namespace {

bool is_number(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Is this open file the maker's end of the terminal with that number? The kernel says so beside it.
bool is_other_end(const fs::path& process, const fs::path& file, const std::string& number) {
  std::error_code error;
  if (fs::read_symlink(file, error).filename() != "ptmx") return false;
  std::ifstream about(process / "fdinfo" / file.filename());
  for (std::string name, value; about >> name >> value;) {
    if (name == "tty-index:") return value == number;
  }
  return false;
}

bool has_made(const fs::path& process, const std::string& number) {
  std::error_code error;
  for (fs::directory_iterator file(process / "fd", error), end; !error && file != end;
       file.increment(error)) {
    if (is_other_end(process, file->path(), number)) return true;
  }
  return false;
}

std::string name_of(const fs::path& process) {
  std::string name;
  std::getline(std::ifstream(process / "comm"), name);
  return name;
}

}  // namespace

std::string owner_of_terminal(const fs::path& terminal) {
  const std::string number = terminal.filename();
  std::error_code error;
  for (fs::directory_iterator process("/proc", error), end; !error && process != end;
       process.increment(error)) {
    const std::string id = process->path().filename();
    if (is_number(id) && has_made(process->path(), number)) {
      return "process " + id + " (" + name_of(process->path()) + ")";
    }
  }
  return "another program";
}

}  // namespace ironbird::hil_bridge::transport
